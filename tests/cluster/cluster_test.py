#!/usr/bin/env python3
"""Verifies 400 recordings in 8 shards by the scripts of scripts/cluster on a Slurm of two nodes, ends one task and
one node midway, and wants each verdict exactly once.

Usage: cluster_test.py PROGRAM ROOT      exits 77 where no Slurm is installed
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import slurm

RECORDINGS = 400
SHARDS = 8
# Each recording takes about so long, that there is a midway.
SECONDS_EACH = 0.04


def record(program, path, ticks, *options):
    subprocess.run([program, "record", "stack", "--ticks", str(ticks), "-o", path, *options], check=True,
                   stdout=subprocess.DEVNULL)


def ticks_for(program, folder, seconds):
    """How many steps of the scene take so long to verify here."""
    path = folder / "trial"
    record(program, path, 400)
    line = subprocess.run([program, "verify", "--json", path], check=True, stdout=subprocess.PIPE).stdout
    return max(20, int(400 * seconds * 1000 / max(json.loads(line)["milliseconds"], 1)))


def make_recordings(program, folder, ticks):
    """No two alike; one in fifty makes a claim that is false, one in fifty is cut."""
    expected = {}

    def make(i):
        path = folder / f"{i:03}.rec"
        claim = ("--claim", "samestep.bodies=99") if i % 50 == 7 else ()
        record(program, path, ticks + i % 20, "--note", f"number={i}", *claim)
        if i % 50 == 9:
            path.write_bytes(path.read_bytes()[:-40])
        expected[str(path)] = ("false claim" if i % 50 == 7 else "incomplete" if i % 50 == 9 else "verified")

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(make, range(RECORDINGS)))
    return expected


def lines_so_far(run):
    """Verdicts by the number of the shard that is not done."""
    counts = {}
    for part in (run / "verdicts").glob("*.part"):
        shard = int(part.name.split(".")[0])
        counts[shard] = counts.get(shard, 0) + part.read_bytes().count(b"\n")
    return counts


def running(cluster):
    """(shard, node) of each task that runs."""
    words = cluster.run("squeue", "-h", "-t", "RUNNING", "-o", "%K %N").split()
    return list(zip(map(int, words[::2]), words[1::2]))


def task_process(run, shard):
    """The process that verifies a shard."""
    wanted = f"{run}/verdicts/{shard}.jsonl"
    return next((pid for pid, words in slurm.processes() if wanted in words), None)


def midway(cluster, run, least):
    """Waits until a task runs that has come to some verdicts."""
    found = []

    def look():
        counts = lines_so_far(run)
        found[:] = [(shard, node) for shard, node in running(cluster) if counts.get(shard, 0) >= least]
        return found

    cluster.wait(look, "a task with verdicts", 40)
    return found[0]


def main(program, root):
    lacking = slurm.missing()
    if lacking:
        print(f"skipped: no Slurm here ({', '.join(lacking)}); 'scripts/setup cluster' installs it")
        return 77
    start = time.monotonic()
    scripts = Path(root) / "scripts" / "cluster"
    with tempfile.TemporaryDirectory(prefix="samestep-cluster-") as name:
        folder = Path(name).resolve()
        (folder / "recordings").mkdir()
        (folder / "slurm").mkdir()
        ticks = ticks_for(program, folder, SECONDS_EACH)
        expected = make_recordings(program, folder / "recordings", ticks)
        print(f"{RECORDINGS} recordings of {ticks} ticks after {time.monotonic() - start:.0f} s")
        with slurm.Slurm(folder / "slurm") as cluster:
            print(f"a Slurm of two nodes after {time.monotonic() - start:.0f} s")
            run = folder / "run"
            print(cluster.run(scripts / "submit", run, "--shards", SHARDS, "--program", program,
                              folder / "recordings", "--", "--max-seconds", "100"), end="")

            shard, node = midway(cluster, run, 3)
            slurm.kill_tree(task_process(run, shard))
            print(f"ended the task of shard {shard} on {node} after {time.monotonic() - start:.0f} s")
            cluster.wait(lambda: (shard, node) not in running(cluster), "the end of that task", 20)
            assert not (run / "verdicts" / f"{shard}.jsonl").exists()
            had = lines_so_far(run)[shard]

            other, node = midway(cluster, run, 3)
            cluster.lose_node(node, task_process(run, other))
            print(f"lost {node}, with shard {other}, after {time.monotonic() - start:.0f} s")
            early = cluster.run(scripts / "merge", run, check=False)
            assert "files are missing" in early and not early.endswith("; 0 of 400 files are missing\n"), early

            print(cluster.run(scripts / "watch", run, "2", check=False), end="")
            log = "".join(path.read_text(errors="replace") for path in (run / "logs").iterdir())
            assert "verdicts were there" in log, log
            print(f"shard {shard} went on from {had} verdicts")
        lines = [json.loads(line) for line in (run / "verdicts.jsonl").read_text().splitlines()]
        verdicts = {line["file"]: line["verdict"] for line in lines}
        assert len(lines) == RECORDINGS, f"{len(lines)} lines"
        assert verdicts == expected, {file: verdict for file, verdict in verdicts.items()
                                      if verdict != expected.get(file)}
        assert (run / "missing").read_text() == ""
        assert not list((run / "verdicts").glob("*.part")), "parts are left"
    took = time.monotonic() - start
    print(f"each of {RECORDINGS} verdicts exactly once, after {took:.0f} s")
    assert took < 180, "three minutes are enough"
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
