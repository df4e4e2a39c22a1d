// SPDX-License-Identifier: MIT
#include "cli/verify/confinement.h"

#include <sys/resource.h>
#include <unistd.h>

#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__)) && __has_include(<linux/seccomp.h>)
#define SAMESTEP_SECCOMP
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <cerrno>
#include <cstddef>
#include <vector>
#endif

namespace samestep::program {
namespace {

void limit(int resource, std::uint64_t most) {
  rlimit held{};
  held.rlim_cur = held.rlim_max = static_cast<rlim_t>(most);
  ::setrlimit(static_cast<decltype(RLIMIT_CORE)>(resource), &held);
}

#ifdef SAMESTEP_SECCOMP

/// Calls that fail, whatever their arguments.
constexpr long kRefused[] = {
    // The network, and other ways out of the process.
    SYS_socket,
    SYS_socketpair,
    SYS_connect,
    SYS_bind,
    SYS_listen,
    SYS_accept,
    SYS_accept4,
    SYS_sendto,
    SYS_sendmsg,
    SYS_sendmmsg,
    SYS_shmget,
    SYS_shmat,
    SYS_msgget,
    SYS_semget,
    SYS_mq_open,
    SYS_memfd_create,
    SYS_keyctl,
    SYS_add_key,
    SYS_request_key,
    // Other processes.
    SYS_execve,
    SYS_execveat,
    SYS_clone,
    SYS_kill,
    SYS_tkill,
    SYS_rt_sigqueueinfo,
    SYS_rt_tgsigqueueinfo,
    SYS_ptrace,
    SYS_process_vm_writev,
    SYS_process_vm_readv,
    SYS_setns,
    SYS_unshare,
    // Files.
    SYS_unlinkat,
    SYS_renameat2,
    SYS_mkdirat,
    SYS_linkat,
    SYS_symlinkat,
    SYS_mknodat,
    SYS_truncate,
    SYS_ftruncate,
    SYS_fallocate,
    SYS_fchmod,
    SYS_fchmodat,
    SYS_fchown,
    SYS_fchownat,
    SYS_utimensat,
    SYS_setxattr,
    SYS_lsetxattr,
    SYS_fsetxattr,
    SYS_removexattr,
    SYS_lremovexattr,
    SYS_fremovexattr,
    SYS_mount,
    SYS_umount2,
    SYS_pivot_root,
    SYS_chroot,
    SYS_swapon,
    SYS_name_to_handle_at,
    SYS_open_by_handle_at,
    // Calls that do any of this by another way.
    SYS_io_uring_setup,
    SYS_io_uring_enter,
    SYS_io_uring_register,
    SYS_bpf,
    SYS_perf_event_open,
    SYS_userfaultfd,
    SYS_io_setup,
    SYS_init_module,
    SYS_finit_module,
    SYS_kexec_load,
    SYS_reboot,
#ifdef SYS_renameat
    SYS_renameat,
#endif
#ifdef __x86_64__
    SYS_fork,
    SYS_vfork,
    SYS_creat,
    SYS_unlink,
    SYS_rename,
    SYS_mkdir,
    SYS_rmdir,
    SYS_link,
    SYS_symlink,
    SYS_mknod,
    SYS_chmod,
    SYS_chown,
    SYS_lchown,
    SYS_utime,
    SYS_utimes,
    SYS_futimesat,
#endif
};

/// Calls that fail as if the kernel had none, so that libraries take the older one.
constexpr long kUnknown[] = {
#ifdef SYS_clone3
    SYS_clone3,
#endif
#ifdef SYS_openat2
    SYS_openat2,
#endif
};

#ifdef __x86_64__
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#else
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#endif

/// A filter of the kernel's for system calls, written down instruction by instruction.
class Filter {
 public:
  Filter() {
    load(offsetof(seccomp_data, arch));
    unless(kArchitecture, SECCOMP_RET_KILL_PROCESS);
    load(offsetof(seccomp_data, nr));
    // Numbers of the other ABI of x86-64.
    answerFrom(0x40000000u, SECCOMP_RET_ERRNO | EPERM);
    for (const long call : kRefused) answer(static_cast<std::uint32_t>(call), SECCOMP_RET_ERRNO | EPERM);
    for (const long call : kUnknown) answer(static_cast<std::uint32_t>(call), SECCOMP_RET_ERRNO | ENOSYS);
    refuseWriting(SYS_openat, 2);
#ifdef __x86_64__
    refuseWriting(SYS_open, 1);
#endif
    refuseOthers(SYS_tgkill);
    put(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  }

  bool install() {
    sock_fprog program{static_cast<unsigned short>(code_.size()), code_.data()};
    return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
  }

 private:
  void put(int code, std::uint32_t value, std::uint8_t yes = 0, std::uint8_t no = 0) {
    code_.push_back({static_cast<std::uint16_t>(code), yes, no, value});
  }
  void load(std::size_t offset) { put(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset)); }
  /// The lower half of an argument.
  void loadArgument(unsigned index) { load(offsetof(seccomp_data, args) + 8 * index); }
  void answer(std::uint32_t value, std::uint32_t what) {
    put(BPF_JMP | BPF_JEQ | BPF_K, value, 0, 1);
    put(BPF_RET | BPF_K, what);
  }
  void answerFrom(std::uint32_t value, std::uint32_t what) {
    put(BPF_JMP | BPF_JGE | BPF_K, value, 0, 1);
    put(BPF_RET | BPF_K, what);
  }
  void unless(std::uint32_t value, std::uint32_t what) {
    put(BPF_JMP | BPF_JEQ | BPF_K, value, 1, 0);
    put(BPF_RET | BPF_K, what);
  }
  /// A call that opens files is left for reading only.
  void refuseWriting(long call, unsigned flags) {
    put(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 4);
    loadArgument(flags);
    put(BPF_JMP | BPF_JSET | BPF_K, O_WRONLY | O_RDWR | O_CREAT | O_TRUNC, 0, 1);
    put(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM);
    put(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  }
  /// A call that signals is left for this process itself, as abort() needs it.
  void refuseOthers(long call) {
    put(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 4);
    loadArgument(0);
    put(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(::getpid()), 1, 0);
    put(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM);
    put(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  }

  std::vector<sock_filter> code_;
};

#endif

}  // namespace

bool confineThisProcess(std::uint64_t megabytes) {
  if (megabytes > 0) limit(RLIMIT_AS, megabytes << 20);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CORE, 0);
#ifdef RLIMIT_NPROC
  limit(RLIMIT_NPROC, 0);
#endif
#ifdef SAMESTEP_SECCOMP
  // It ends with the process that gave it work.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0);
  return Filter().install();
#else
  return false;
#endif
}

}  // namespace samestep::program
