"""A Slurm of two nodes on this machine, in a folder, without touching the system's own."""

import os
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

NEEDED = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "sinfo")
NODES = ("n1", "n2")

CONFIGURATION = """
ClusterName=scratch
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
SlurmctldPort={port}
SlurmdPort={port_of_nodes}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,batch_sched_delay=1
SwitchType=switch/none
ReturnToService=2
SlurmdTimeout=8
MaxArraySize=100001
MaxJobCount=200000
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={port1} CPUs=1 RealMemory=500
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={port2} CPUs=1 RealMemory=500
PartitionName=verify Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def folder_of(tool):
    """Daemons are in sbin, which is not in everybody's PATH."""
    path = os.pathsep.join((os.environ.get("PATH", ""), "/usr/sbin", "/usr/local/sbin"))
    return shutil.which(tool, path=path)


def missing():
    """The programs that a Slurm needs and that are not here."""
    return [tool for tool in NEEDED if folder_of(tool) is None]


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class Slurm:
    """Starts with `with`; ends its own daemons only, by their process ids."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"))
        self.daemons = {}

    def __enter__(self):
        import getpass

        ports = free_ports(4)
        host = socket.gethostname().split(".")[0]
        for name in ("state", "spool-n1", "spool-n2"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            host=host, user=getpass.getuser(), folder=self.folder, port=ports[0], port_of_nodes=ports[1],
            port1=ports[2], port2=ports[3]))
        self.start("munged", "--foreground", "--force", f"--key-file={key}",
                   f"--socket={self.folder}/munge.socket", f"--pid-file={self.folder}/munged.pid",
                   f"--log-file={self.folder}/munged.log", f"--seed-file={self.folder}/munged.seed")
        self.wait(lambda: (self.folder / "munge.socket").exists(), "munge's socket", 20)
        self.start("slurmctld", "-D", "-c", "-f", self.environment["SLURM_CONF"])
        for node in NODES:
            self.start_node(node)
        self.wait(self.is_up, "both nodes", 40)
        return self

    def __exit__(self, *_):
        for process in reversed(list(self.daemons.values())):
            if process.poll() is None:
                process.send_signal(signal.SIGTERM)
        for process in self.daemons.values():
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def start(self, tool, *arguments, name=None):
        log = open(self.folder / f"{name or tool}.out", "ab")
        self.daemons[name or tool] = subprocess.Popen(
            [folder_of(tool), *arguments], stdin=subprocess.DEVNULL, stdout=log, stderr=log,
            env=self.environment, start_new_session=True)

    def start_node(self, node):
        self.start("slurmd", "-D", "-N", node, "-f", self.environment["SLURM_CONF"], name=node)

    def lose_node(self, node, task):
        """The daemon of the node is gone at once, and so is the task that it runs, by a process of it."""
        daemon = self.daemons.pop(node)
        step = above(task, "slurmstepd")
        daemon.kill()
        daemon.wait()
        kill_tree(step)

    def run(self, *words, check=True):
        done = subprocess.run([str(word) for word in words], env=self.environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if check and done.returncode != 0:
            raise AssertionError(f"{' '.join(map(str, words))}: exit {done.returncode}\n{done.stdout}")
        return done.stdout

    def is_up(self):
        return self.run("sinfo", "-h", "-N", "-o", "%N %t", check=False).split().count("idle") == len(NODES)

    def wait(self, condition, what, seconds):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                raise AssertionError(f"{what}: not there after {seconds} s\n{self.logs()}")
            time.sleep(0.2)

    def logs(self):
        return "\n".join(f"== {path.name}\n" + path.read_text(errors="replace")[-3000:]
                         for path in sorted(self.folder.glob("*.log")))


def processes():
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                yield int(entry.name), (entry / "cmdline").read_bytes().decode(errors="replace").split("\0")
            except OSError:
                continue


def parent_of(pid):
    """0 where the process is gone."""
    try:
        return int((Path("/proc") / str(pid) / "stat").read_text().rpartition(")")[2].split()[1])
    except OSError:
        return 0


def above(pid, name):
    """The process of that name that this one comes from."""
    words = dict(processes())
    while pid and name not in words.get(pid, [""])[0]:
        pid = parent_of(pid)
    assert pid, f"no {name} above"
    return pid


def children_of(pid):
    return [other for other, _ in processes() if parent_of(other) == pid]


def kill_tree(pid):
    """This process and all below it; the parents first, so that none starts another."""
    below = children_of(pid)
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    for child in below:
        kill_tree(child)
