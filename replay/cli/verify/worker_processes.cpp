// SPDX-License-Identifier: MIT
#include "cli/verify/worker_processes.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "cli/program.h"
#include "cli/verify/confinement.h"

#if defined(__unix__) && !defined(__EMSCRIPTEN__) && !defined(__wasi__)
#define SAMESTEP_PROCESSES
#elif defined(__APPLE__)
#define SAMESTEP_PROCESSES
#endif

#ifdef SAMESTEP_PROCESSES
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#endif

namespace samestep::program {

WorkerProcesses::WorkerProcesses(const std::vector<std::string>& files, const VerifyPlan& plan,
                                 std::size_t count, std::uint64_t megabytes)
    : files_(files), plan_(plan), megabytes_(megabytes), workers_(count), said_(files.size()) {}

#ifdef SAMESTEP_PROCESSES
namespace {

/// Head of an answer, before its text.
struct AnswerHead {
  std::uint64_t ticks = 0;
  std::uint64_t out = 0;
  std::uint64_t error = 0;
  std::uint64_t verdict = 0;
};

bool writeAll(int to, const void* data, std::size_t size) {
  const char* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(to, from, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    from += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

bool readAll(int from, void* data, std::size_t size) {
  char* to = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::read(from, to, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

/// Number of files after which a process makes room for another: what it left behind, such as memory in
/// pieces, ends with it.
constexpr std::size_t kFilesOfAProcess = 1000;

/// Verifies a file; a failure that cannot even be said is left to the parent, which finds the process gone.
Said verifyOrEnd(const std::string& file, const VerifyPlan& plan) {
  try {
    return verifyFile(file, plan);
  } catch (const std::exception&) {
    ::_exit(kUnusable);
  }
}

/// Says in words what became of a process.
std::string endOf(int status) {
  if (WIFSIGNALED(status)) return "was ended by signal " + std::to_string(WTERMSIG(status));
  return "ended with code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

bool WorkerProcesses::available() { return true; }

WorkerProcesses::~WorkerProcesses() {
  for (Worker& worker : workers_) close(worker);
}

void WorkerProcesses::close(Worker& worker) {
  if (worker.process == 0) return;
  ::close(worker.orders);
  ::close(worker.answers);
  int status = 0;
  while (::waitpid(worker.process, &status, 0) < 0 && errno == EINTR) continue;
  worker.process = 0;
}

void WorkerProcesses::start(Worker& worker) {
  int orders[2];
  int answers[2];
  if (::pipe(orders) != 0 || ::pipe(answers) != 0) throw Unusable("no more pipes");
  std::fflush(stdout);
  const pid_t process = ::fork();
  if (process < 0) throw Unusable("no more processes");
  if (process == 0) {
    // The pipes of the others would keep them waiting.
    for (const Worker& other : workers_) {
      if (other.process == 0) continue;
      ::close(other.orders);
      ::close(other.answers);
    }
    ::close(orders[1]);
    ::close(answers[0]);
    serve(orders[0], answers[1]);
  }
  ::close(orders[0]);
  ::close(answers[1]);
  worker.process = process;
  worker.orders = orders[1];
  worker.answers = answers[0];
  worker.received.clear();
  worker.files = 0;
}

void WorkerProcesses::serve(int orders, int answers) const {
  confineThisProcess(megabytes_);
  std::uint64_t file = 0;
  while (readAll(orders, &file, sizeof file)) {
    const Said said = verifyOrEnd(files_[static_cast<std::size_t>(file)], plan_);
    const AnswerHead head{said.ticks, said.out.size(), said.error.size(),
                          static_cast<std::uint64_t>(said.verdict)};
    if (!writeAll(answers, &head, sizeof head) || !writeAll(answers, said.out.data(), said.out.size()) ||
        !writeAll(answers, said.error.data(), said.error.size())) {
      break;
    }
  }
  ::_exit(0);
}

/// Gives it the next file; lets it go where there is none.
void WorkerProcesses::assign(Worker& worker) {
  if (next_ == files_.size()) return close(worker);
  if (worker.files == kFilesOfAProcess) {
    close(worker);
    start(worker);
  }
  ++worker.files;
  worker.since = milliseconds();
  worker.file = next_++;
  const std::uint64_t file = worker.file;
  // One that is gone is found when it does not answer.
  writeAll(worker.orders, &file, sizeof file);
}

/// Tells of the file at which a process ended, and puts another in its place.
void WorkerProcesses::bury(Worker& worker) {
  ::close(worker.orders);
  ::close(worker.answers);
  int status = 0;
  while (::waitpid(worker.process, &status, 0) < 0 && errno == EINTR) continue;
  worker.process = 0;
  const std::string& file = files_[worker.file];
  keep(worker.file,
       saidUnusable(file, file + ": the process that verified it " + endOf(status), false, plan_));
  if (next_ == files_.size()) return;
  start(worker);
  assign(worker);
}

void WorkerProcesses::receive(Worker& worker) {
  char piece[4096];
  const ssize_t got = ::read(worker.answers, piece, sizeof piece);
  if (got < 0 && errno == EINTR) return;
  if (got <= 0) return bury(worker);
  worker.received.append(piece, static_cast<std::size_t>(got));
  AnswerHead head;
  if (worker.received.size() < sizeof head) return;
  std::memcpy(&head, worker.received.data(), sizeof head);
  if (worker.received.size() < sizeof head + head.out + head.error) return;
  const auto out = static_cast<std::size_t>(head.out);
  keep(worker.file,
       Said{static_cast<Verdict>(head.verdict), head.ticks, worker.received.substr(sizeof head, out),
            worker.received.substr(sizeof head + out, static_cast<std::size_t>(head.error))});
  worker.received.clear();
  assign(worker);
}

void WorkerProcesses::keep(std::size_t file, Said&& said) {
  said_[file] = std::move(said);
  ended_.push_back(file);
}

/// Ends those that do not keep the time they were given: they are stuck where nobody asks for it.
void WorkerProcesses::endOverdue() {
  if (plan_.seconds == 0) return;
  const std::int64_t grace = plan_.seconds * 2000 + 2000;
  for (const Worker& worker : workers_) {
    if (worker.process != 0 && milliseconds() - worker.since > grace) ::kill(worker.process, SIGKILL);
  }
}

void WorkerProcesses::run(const std::function<void(std::size_t, const Said&)>& tell, bool inOrder) {
  constexpr int kLookMilliseconds = 1000;
  ::signal(SIGPIPE, SIG_IGN);
  for (Worker& worker : workers_) {
    start(worker);
    assign(worker);
  }
  for (std::size_t told = 0; told < files_.size();) {
    std::vector<pollfd> waits;
    std::vector<Worker*> waiting;
    for (Worker& worker : workers_) {
      if (worker.process == 0) continue;
      waits.push_back({worker.answers, POLLIN, 0});
      waiting.push_back(&worker);
    }
    if (::poll(waits.data(), static_cast<nfds_t>(waits.size()), kLookMilliseconds) < 0 && errno != EINTR) {
      throw Unusable("the processes cannot be waited for");
    }
    endOverdue();
    for (std::size_t i = 0; i < waits.size(); ++i) {
      if (waits[i].revents != 0) receive(*waiting[i]);
    }
    const auto isNext = [&] { return inOrder ? said_[told].has_value() : told < ended_.size(); };
    for (; told < files_.size() && isNext(); ++told) {
      const std::size_t file = inOrder ? told : ended_[told];
      tell(file, *said_[file]);
      said_[file] = Said{};
    }
  }
}

#else

bool WorkerProcesses::available() { return false; }
WorkerProcesses::~WorkerProcesses() = default;
void WorkerProcesses::run(const std::function<void(std::size_t, const Said&)>&, bool) {
  throw Unusable("this system has no processes");
}

#endif

}  // namespace samestep::program
