#!/usr/bin/env python3
"""What scripts/platforms makes of what a runner prints: nothing but every expected hash counts as equal."""

import importlib.util
import sys
import tempfile
import unittest
from importlib.machinery import SourceFileLoader
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/platforms"
sys.dont_write_bytecode = True
loader = SourceFileLoader("platforms", str(SCRIPT))
platforms = importlib.util.module_from_spec(importlib.util.spec_from_loader("platforms", loader))
sys.modules["platforms"] = platforms
loader.exec_module(platforms)

EXPECTED = {("stack.fixed", 1): "00000000000000aa", ("stack.fixed", 2): "00000000000000bb"}
FULL = "platform: 32 big GNU 12.2.0\nstack.fixed 1 00000000000000aa\nstack.fixed 2 00000000000000bb\nend\n"


def result_of(text):
    _, hashes, stopped = platforms.read_hashes(text)
    return platforms.compare(hashes, EXPECTED, stopped)


def outcome_of(*results):
    rows = [{"scalar": scalar, "ticks": 1, "result": result} for scalar, result in zip(("fixed", "double"), results)]
    return {"about": "64 little GNU 12.2.0", "seconds": [1, 1], "rows": rows}


class Judging(unittest.TestCase):
    def test_every_expected_hash_is_equal(self):
        self.assertEqual(result_of(FULL), ("equal", 2))

    def test_lines_may_end_as_on_windows(self):
        self.assertEqual(result_of(FULL.replace("\n", "\r\n")), ("equal", 2))

    def test_another_hash_is_different_at_its_tick(self):
        result, _ = result_of(FULL.replace("bb", "bc"))
        self.assertEqual(result, "DIFFERENT: stack.fixed first at tick 2")

    def test_a_tick_that_is_lacking_is_different(self):
        result, count = result_of(FULL.replace("stack.fixed 2 00000000000000bb\n", ""))
        self.assertEqual((result, count), ("DIFFERENT: stack.fixed has no tick 2", 1))

    def test_a_runner_that_stops_is_different_and_says_why(self):
        text = FULL.replace("stack.fixed 2 00000000000000bb\nend\n", "runner answered -11: no output\n")
        self.assertEqual(result_of(text)[0],
                         "DIFFERENT: stack.fixed has no tick 2, the runner stopped: runner answered -11: no output")

    def test_a_runner_that_fails_after_its_last_hash_is_different(self):
        result, _ = result_of(FULL + "runner answered 23: SUMMARY: 8 bytes leaked\n")
        self.assertTrue(result.startswith("DIFFERENT: the runner stopped: runner answered 23"), result)

    def test_a_runner_that_does_not_start_has_not_run(self):
        with self.assertRaises(platforms.NotRun):
            platforms.read_hashes("wine: could not load\n")


class Closing(unittest.TestCase):
    def closing(self, *outcomes):
        return platforms.closing([(platforms.PLATFORMS[0], done) for done in outcomes])

    def test_all_equal(self):
        self.assertEqual(self.closing(outcome_of("equal", "equal"), outcome_of("equal")),
                         ("platforms: 2 run, 2 equal, 0 different, 0 not run", 0))

    def test_one_scalar_that_differs_makes_the_platform_different(self):
        self.assertEqual(self.closing(outcome_of("equal", "DIFFERENT: x"), outcome_of("equal")),
                         ("platforms: 2 run, 1 equal, 1 different, 0 not run", 1))

    def test_a_missing_tool_is_counted_and_has_its_own_status(self):
        self.assertEqual(self.closing(outcome_of("not run: em++ of emscripten"), outcome_of("equal")),
                         ("platforms: 1 run, 1 equal, 0 different, 1 not run", 3))

    def test_a_build_that_fails_is_a_failure(self):
        self.assertEqual(self.closing(outcome_of("NOT RUN: ninja answered 1"), outcome_of("equal")),
                         ("platforms: 1 run, 1 equal, 0 different, 1 not run", 1))


class Table(unittest.TestCase):
    def test_scalars_of_one_result_share_a_row(self):
        lines = platforms.table([(platforms.PLATFORMS[0], outcome_of("equal", "equal"))])
        self.assertEqual(len(lines), 3)
        self.assertIn("| fixed, double | 2 ", lines[2])

    def test_scalars_of_different_results_do_not(self):
        lines = platforms.table([(platforms.PLATFORMS[0], outcome_of("equal", "DIFFERENT: x"))])
        self.assertEqual([line.split(" | ")[-1] for line in lines[2:]], ["equal |", "DIFFERENT: x |"])

    def test_the_page_takes_it_between_the_marks_and_the_readme_the_count(self):
        with tempfile.TemporaryDirectory() as folder:
            platforms.PAGE = Path(folder) / "platforms.md"
            platforms.README = Path(folder) / "README.md"
            start, end = platforms.PAGE_MARKS
            platforms.PAGE.write_text(f"before\n{start}old\n{end}after\n")
            platforms.README.write_text("Compared so far: 1 platforms, 1 equal, after every tick\n")
            platforms.update_docs(["new"], ["37", "36"])
            self.assertEqual(platforms.PAGE.read_text(), f"before\n{start}new\n{end}after\n")
            self.assertEqual(platforms.README.read_text(),
                             "Compared so far: 37 platforms, 36 equal, after every tick\n")


class Names(unittest.TestCase):
    def test_no_two_platforms_share_a_name(self):
        names = [platform.name for platform in platforms.PLATFORMS]
        self.assertEqual(len(names), len(set(names)))

    def test_an_unknown_name_is_refused(self):
        with self.assertRaises(SystemExit):
            platforms.selected(["vax"])

    def test_quick_covers_what_ci_promises(self):
        quick = {platform.name for platform in platforms.selected(["quick"])}
        self.assertLessEqual({"i686", "s390x", "x86-64-no-int128", "wasm-wasi", "x86-64-clang-14"}, quick)


class Proofs(unittest.TestCase):
    def test_the_native_snapshot_is_played_on_and_every_snapshot_and_fingerprint_compared(self):
        hashes = {("arena.fixed", tick): f"{tick:016x}" for tick in range(1, 5)}
        hashes[("stack.fixed", 4)] = "a" * 16
        native = {("arena.fixed@saved", 2): "b" * 16, ("arena.fixed", 1): "c" * 16, ("game.double", 0): "e" * 16}
        with tempfile.TemporaryDirectory() as golden:
            (Path(golden) / "fingerprint.txt").write_text("fixed dddddddddddddddd\n")
            more = platforms.proofs.expected(hashes, native, 4, Path(golden))
        self.assertEqual(more, {("arena.fixed@saved", 2): "b" * 16, ("arena.fixed@2", 3): f"{3:016x}",
                                ("arena.fixed@2", 4): f"{4:016x}", ("fingerprint.fixed", 0): "d" * 16,
                                ("game.double", 0): "e" * 16})

    def test_lines_belong_to_a_scalar_and_only_some_names_are_files(self):
        names = ["arena.fixed", "arena.fixed@saved", "arena.fixed@300", "fingerprint.fixed", "game.fixed"]
        self.assertEqual(platforms.proofs.files(names), ["arena.fixed", "arena.fixed@300"])
        self.assertEqual({platforms.proofs.recording_of(name).rsplit(".", 1)[1] for name in names}, {"fixed"})


if __name__ == "__main__":
    unittest.main()
