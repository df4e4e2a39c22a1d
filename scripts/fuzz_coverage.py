"""Coverage of the collision and parsing files by the committed fuzz corpora: `scripts/fuzz --coverage`."""

import json
import os
import re
import subprocess
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "coverage"

# What is looked at, and by which targets.
GROUPS = {
    "collision": ("""
        src/narrow_phase/collision.cpp src/narrow_phase/gjk.cpp src/narrow_phase/gjk.h src/narrow_phase/epa.cpp src/narrow_phase/time_of_impact.cpp src/narrow_phase/clip.h src/narrow_phase/support.h src/narrow_phase/support_faces.h
        src/geometry/circle_shape.cpp src/geometry/segment_shape.cpp src/geometry/poly_shape.cpp src/geometry/shape.cpp src/geometry/shape_edges.h
        src/geometry/shape_geometry.h src/geometry/shape_query.cpp src/contacts/contact_geometry.h src/contacts/push_contacts.h
        src/broad_phase/bb_tree.cpp src/broad_phase/box_tree.cpp src/broad_phase/brute_force_index.cpp src/broad_phase/spatial_index.cpp""",
                  ("collide", "gjk_epa", "time_of_impact", "hull", "bb_tree", "space", "snapshot", "scene")),
    "parsing": ("""
        src/snapshot/snapshot.cpp src/snapshot/space_codec.cpp src/state/canonical_reader.h src/state/compact.h src/math/decimal_double.cpp
        fixed/include/samestep/raw_decimal.h fixed/include/samestep/raw_parse_decimal.h fixed/include/samestep/fixed_text.h
        replay/recording/recording.cpp replay/recording/replay.cpp replay/recording/command.cpp replay/scenes/json.cpp replay/scenes/scene.cpp
        replay/scenes/scene_builder.cpp replay/scenes/scene_csv.cpp replay/scenes/scene_cursor.cpp replay/scenes/scene_events.cpp
        replay/scenes/scene_source.cpp
        replay/scenes/scene_families.cpp""",
                ("snapshot", "recording", "scene", "functions", "space")),
}


class Counts:
    """Of one file: how often each line was reached, and each of a condition's two ways."""

    def __init__(self):
        self.lines = defaultdict(int)
        self.ways = defaultdict(int)

    def text(self):
        return " ".join(f"{reached:5} of {total:5} {100 * reached / max(1, total):6.1f} %"
                        for reached, total in (self.reached(self.lines), self.reached(self.ways)))

    @staticmethod
    def reached(counts):
        return sum(1 for count in counts.values() if count > 0), len(counts)


def build(targets):
    subprocess.run(["cmake", "--preset", "coverage"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", "--preset", "coverage", "--target", *[f"replay_{t}" for t in targets]],
                   cwd=ROOT, check=True, stdout=subprocess.DEVNULL)


def profile(target, corpora):
    """What a target reaches by its corpus. @return lines as lcov text, and branches of each file"""
    program = BUILD / "fuzz" / f"replay_{target}"
    raw, merged = BUILD / f"{target}.profraw", BUILD / f"{target}.profdata"
    subprocess.run([str(program), str(corpora / target)], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "LLVM_PROFILE_FILE": str(raw)})
    subprocess.run(["llvm-profdata-14", "merge", "-sparse", str(raw), "-o", str(merged)], check=True)
    raw.unlink()
    export = ["llvm-cov-14", "export", f"-instr-profile={merged}", str(program)]
    lines = subprocess.run([*export, "-format=lcov"], check=True, capture_output=True, text=True).stdout
    whole = json.loads(subprocess.run(export, check=True, capture_output=True, text=True).stdout)
    return lines, {file["filename"]: file["branches"] for file in whole["data"][0]["files"]}


def add(profiled, wanted, files):
    """Adds counts: a line or a way is reached where it is in any instantiation, by any target."""
    lines, branches = profiled
    counts = None
    for line in lines.splitlines():
        kind, _, rest = line.partition(":")
        if kind == "SF":
            name = os.path.relpath(rest, ROOT)
            counts = files[name] if name in wanted else None
        elif counts is not None and kind == "DA":
            number, count = rest.split(",")[:2]
            counts.lines[int(number)] += int(count)
    for path, ways in branches.items():
        name = os.path.relpath(path, ROOT)
        if name not in wanted:
            continue
        source = (ROOT / name).read_text().splitlines()
        for line, column, _, _, taken, passed, *_ in ways:
            # Decided when it is compiled: neither way is counted.
            if "if constexpr" in source[line - 1]:
                continue
            files[name].ways[line, column, "true"] += taken
            files[name].ways[line, column, "false"] += passed


def is_excused(text):
    """Whether a line has nothing to reach: a brace, or the end of a declaration."""
    return re.fullmatch(r"[\s{}();]*(//.*)?", text) is not None


def report(targets, corpora, with_lines):
    """Prints the table."""
    build(targets)
    profiles = {target: profile(target, corpora) for target in targets}
    for group, (names, by) in GROUPS.items():
        wanted = names.split()
        files = defaultdict(Counts)
        for target in by:
            if target in profiles:
                add(profiles[target], wanted, files)
        whole = Counts()
        print(f"{group} files{'':22}                lines                branches")
        for name in wanted:
            if name not in files:
                continue
            print(f"  {name:42} {files[name].text()}")
            for key, count in files[name].lines.items():
                whole.lines[name, key] = count
            for key, count in files[name].ways.items():
                whole.ways[name, key] = count
        print(f"  {'all':42} {whole.text()}")
        if not with_lines:
            continue
        for name in wanted:
            source = (ROOT / name).read_text().splitlines()
            for number, count in sorted(files[name].lines.items()):
                if count == 0 and not is_excused(source[number - 1]):
                    print(f"  {name}:{number}: {source[number - 1].strip()}")
            for (number, column, way), count in sorted(files[name].ways.items()):
                if count == 0 and files[name].lines.get(number, 0) > 0:
                    print(f"  {name}:{number}:{column} never {way}: {source[number - 1].strip()}")
