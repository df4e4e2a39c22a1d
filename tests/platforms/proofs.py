"""What scripts/platforms proves beside the hashes of recordings: the fingerprint, that a game's own double code
gives the same under the flags of the library, and that snapshots travel.

Every platform saves a snapshot halfway through every recording: its bytes must be those that the native build
saved, so that what it saved can be loaded natively. And of some scenes it loads the native snapshot and plays on.
Names of the runner's lines: see runner.cpp.
"""
# Small ones, with callbacks that remove bodies, inputs, and both solvers.
SCENES = ("arena", "handlers", "soft-mixer")


def halfway(ticks):
    return ticks // 2


def options(ticks):
    """Of the runner, to save snapshots."""
    return ["--save-at", str(halfway(ticks))]


def recording_of(name):
    """The recording that a line of the runner is about."""
    return name.split("@")[0]


def files(names):
    """Of the names of lines, those that are files."""
    return [name for name in names if not name.endswith("@saved") and not name.startswith(("fingerprint.", "game."))]


def expected(hashes, natively_saved, ticks, golden):
    """Lines beyond `hashes`, which are those of the recordings: {(name, tick): hash}.

    natively_saved: what the native runner printed when it wrote the snapshots.
    """
    more = {key: value for key, value in natively_saved.items()
            if key[0].endswith("@saved") or key[0].startswith("game.")}
    for (name, tick), value in hashes.items():
        if name.rsplit(".", 1)[0] in SCENES and tick > halfway(ticks):
            more[(f"{name}@{halfway(ticks)}", tick)] = value
    for line in (golden / "fingerprint.txt").read_text().splitlines():
        scalar, value = line.split()
        more[(f"fingerprint.{scalar}", 0)] = value
    return more
