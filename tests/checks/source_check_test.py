#!/usr/bin/env python3
"""Each rule of source_check.py fires on a bad snippet, and stays silent on its good twin."""

import tempfile
import unittest
from pathlib import Path

import source_check

HEADER = "include/samestep/body.h"
SOURCE = "src/dynamics/body.cpp"

# Sources that give public headers their layers.
ROOMS = {"src/dynamics/body.cpp": "", "src/world/space.cpp": "", "src/geometry/shape.cpp": ""}


def problems(files):
    """What the check says of a tree that holds these files."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in {**ROOMS, **files}.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        check = source_check.Check(folder)
        check.run()
        return check.problems


def header(body):
    return "#pragma once\n" + body


def member(declaration):
    return header(f"namespace samestep {{\nclass Body {{\n public:\n  {declaration}\n}};\n}}\n")


# rule, file, what breaks it, what is allowed
SNIPPETS = [
    ("unordered", SOURCE, "std::unordered_map<int, int> map;\n", "HashSet<int> set;  // unordered_map has no order\n"),
    ("unordered", SOURCE, "#include <unordered_set>\n", "#include <vector>\n"),
    ("libm", SOURCE, "double y = std::sin(x);\n", "auto y = samestep::sincos(x).sin;\n"),
    ("libm", SOURCE, "double y = cos (x);\n", "S y = exp(x) + pow(x, y) + atan2(y, x);\n"),
    ("libm", SOURCE, "double y = ::pow(x, 2);\n", "double y = samestep::pow(x, 2);\n"),
    ("libm", SOURCE, "double y = __builtin_fma(a, b, c);\n", "double y = mulAdd(a, b, c);\n"),
    ("libm", SOURCE, "double y = std::fabs(x);\n", "S y = abs(x);\n"),
    ("cmath", SOURCE, "#include <cmath>\n", "#include <samestep/math.h>\n"),
    ("sqrt", SOURCE, "double y = std::sqrt(x);\n", "S y = sqrt(x) + samestep::sqrt(x);\n"),
    ("sort", SOURCE, "std::sort(a, b);\n", "// total order: ids are unique\nstd::sort(a, b);\n"),
    ("sort", SOURCE, "std::ranges::sort(a);\n", "std::ranges::sort(a);  // total order: ids are unique\n"),
    ("sort", SOURCE, "// total order: ids\nint c;\nstd::sort(a, b);\n",
     "// total order: ids\n// are unique\nstd::sort(a, b);\n"),
    ("sort", SOURCE, "std::sort(a, b);  // total order:\n", "std::stable_sort(a, b);\n"),
    ("sort", SOURCE, "std::priority_queue<int> q;\n", "std::vector<int> q;\n"),
    ("clock", SOURCE, "auto t = std::chrono::steady_clock::now();\n", "auto t = tick;\n"),
    ("clock", SOURCE, "#include <chrono>\n", "#include <chrono>  // not in results: shown as speed\n"),
    ("random", SOURCE, "std::random_device seed;\n", "std::mt19937_64 numbers(seed);\n"),
    ("random", SOURCE, "int x = rand();\n", "int x = operand(y);\n"),
    ("random", SOURCE, "std::uniform_int_distribution<int> d(0, 5);\n", "int d = numbers() % 6;\n"),
    ("random", SOURCE, "std::shuffle(a, b, g);\n", "riffle(a, b, g);\n"),
    ("address", SOURCE, "auto x = reinterpret_cast<std::uintptr_t>(p);\n", "auto x = reinterpret_cast<char*>(p);\n"),
    ("address", SOURCE, "std::less<Body*> order;\n", "std::less<BodyId> order;\n"),
    ("std-hash", SOURCE, "auto h = std::hash<int>()(x);\n", "auto h = hash(x);\n"),
    ("parallel-sum", SOURCE, "auto s = std::reduce(a, b);\n", "auto s = std::accumulate(a, b, 0);\n"),
    ("decimal", SOURCE, "double x = std::stod(text);\n", "parseDecimal(text, x);\n"),
    ("long-double", SOURCE, "long double x = 1;\n", "double x = 1;\n"),
    ("macro", SOURCE, "#define SQUARE(x) ((x) * (x))\n", "#define SAMESTEP_INT128 1\n"),
    ("guard", HEADER, "class Body;\n", header("class Body;\n")),
    ("client-header", "include/samestep/space.h", header("#include <string>\n"), header("#include <vector>\n")),
    ("heavy-header", HEADER, header("#include <functional>\n"), header("#include <vector>\n")),
    ("unsized-member", HEADER, member("std::size_t count_ = 0;"), member("std::uint64_t count_ = 0;")),
    ("unsized-member", HEADER, member("unsigned long count_{0};"), member("static constexpr std::size_t kMax = 2;")),
    ("unsized-member", HEADER, member("std::vector<long> counts_;"), member("std::size_t count() const;")),
    ("unsized-member", HEADER, member("size_t n;"), member("size_t n() const { size_t k = 0; return k; }")),
    ("unsized-member", HEADER, member("long a_;"), member("// not state: scratch of a step\n  long a_;")),
    ("unsized-member", HEADER, header("template <class T>\nstruct A {\n  T x{};\n  std::ptrdiff_t y;\n};\n"),
     header("template <class T>\nstd::size_t count(T x) {\n  std::size_t y = x;\n  return y;\n}\n")),
    ("layer", "src/elsewhere.cpp", "int x;\n", "// see tests/checks/layers.txt\n"),
    ("leftover", SOURCE, "// TO" + "DO: finish\n", "// Done.\n"),
    ("leftover", "docs/notes.md", "FIX" + "ME\n", "Fixed.\n"),
    ("skipped-test", "tests/dynamics/body_test.cpp", "GTEST_" + "SKIP();\n", "ASSERT_TRUE(x);\n"),
    ("skipped-test", "tests/dynamics/body_test.cpp", "TEST(A, DISA" + "BLED_B) {}\n", "TEST(A, Disabled) {}\n"),
    ("long-line", SOURCE, "// " + "x" * 108 + "\n", "// " + "x" * 107 + "\n"),
    ("machine-path", "scripts/run", "cd /ho" + "me/me\n", "cd ../home/me\n"),
]


class SourceCheck(unittest.TestCase):
    def test_each_rule_fires_on_its_bad_snippet_and_not_on_the_good_one(self):
        for rule, path, bad, good in SNIPPETS:
            with self.subTest(rule=rule, bad=bad):
                self.assertTrue(any(f"[{rule}]" in line for line in problems({path: bad})), problems({path: bad}))
                if rule != "layer":
                    self.assertEqual(problems({path: good}), [])

    def test_every_rule_has_a_snippet(self):
        tried = {rule for rule, *_ in SNIPPETS}
        self.assertEqual({rule.name for rule in source_check.RULES} - tried, set())

    def test_message_names_file_line_and_replacement(self):
        found = problems({SOURCE: "\n\nint x = std::rand();\n"})
        self.assertEqual(len(found), 1)
        self.assertRegex(found[0], r"^src/dynamics/body\.cpp:3: \[random\] .*mt19937_64")

    def test_function_of_too_many_lines(self):
        body = "  work();\n" * 68
        self.assertEqual(problems({SOURCE: f"void Body::move() {{\n{body}}}\n"}), [])
        found = problems({SOURCE: f"namespace samestep {{\nvoid Body::move() {{\n{body}  work();\n}}\n}}\n"})
        self.assertEqual(len(found), 1)
        self.assertRegex(found[0], r"body\.cpp:2: \[long-function\] 71 lines")

    def test_a_long_function_of_a_class_counts_and_a_lambda_belongs_to_its_function(self):
        work = "    work();\n" * 70
        self.assertRegex("".join(problems({HEADER: header(f"class Body {{\n  void move() {{\n{work}  }}\n}};\n")})),
                         r"body\.h:3: \[long-function\] 72 lines")
        found = problems({SOURCE: f"void move() {{\n  const auto go = [] {{\n{work}  }};\n}}\n"})
        self.assertEqual([line.split("]")[0] for line in found], ["src/dynamics/body.cpp:1: [long-function"])

    def test_a_class_or_a_table_may_have_many_lines(self):
        rows = "  1,\n" * 100
        self.assertEqual(problems({SOURCE: f"constexpr int kTable[] = {{\n{rows}}};\n"}), [])
        members = "  void f();\n" * 100
        self.assertEqual(problems({HEADER: header(f"class Body {{\n{members}}};\n")}), [])

    def test_header_that_nothing_uses(self):
        self.assertRegex("".join(problems({"include/samestep/transform.h": header("")})), r"\[dead-header\]")
        self.assertEqual(problems({"include/samestep/transform.h": header(""),
                                   SOURCE: "#include <samestep/transform.h>\n"}), [])

    def test_what_the_formatter_mangles(self):
        for bad in ("bool a = (b < kMost)&&in(c);\n", "bool a = in(b, kMax<S>)&&in(c);\n", "const X&a = b, &c = d;\n"):
            self.assertRegex("".join(problems({SOURCE: bad})), r"\[mangled\]", bad)
        self.assertEqual(problems({SOURCE: "bool a = b < kMost && in(c);\nvoid take(S&& from, S& to);\n"}), [])

    def test_comments_that_begin_in_the_middle_of_a_sentence(self):
        for text in ("What a block needs once in a while.", "Of a substep.", "Whether the body may turn.", "As they are.",
                     "The same for bits that are known.", "How far along.", "Who is told.", "From the centre, m.",
                     "With springs, before anything moves."):
            self.assertTrue(source_check.is_fragment(text), text)
        for text in ("Cold data of a block: what it needs once in a while.", "True if the body may turn.",
                     "In a step that finds nothing new there is nothing to do.", "Where a point touches, it may roll.",
                     "SPDX-License-Identifier: MIT", "namespace samestep", "@param way  of A against B, m"):
            self.assertFalse(source_check.is_fragment(text), text)

    def test_fragments_are_told_where_they_are_more_than_a_few(self):
        one = "/// Of the body, kg.\nint a;\n\nint b;  ///< What is left.\n"
        found = problems({SOURCE: one})
        self.assertRegex("".join(found), r"body\.cpp:1: \[fragment\] 'Of the body, kg\.")
        self.assertRegex("".join(found), r"body\.cpp:4: \[fragment\] 'What is left\.")
        whole = "/// Mass of the body, kg.\nint a;\n" * 100
        self.assertEqual(problems({SOURCE: one + whole}), [])

    def test_a_comment_block_is_all_its_lines(self):
        self.assertEqual(list(source_check.comment_blocks("// Mass\n// of a body.\nint a;  ///< kg.\n")),
                         [(0, "Mass of a body."), (2, "kg.")])

    def test_comments_and_strings_are_not_code(self):
        quiet = ('/* std::sin(x)\n std::cos(x) */\nauto a = "std::sort(x)";\nauto b = R"(rand())";\n'
                 "int c = 1'000;  // std::sqrt(2)\nint d = 2'000;\n")
        self.assertEqual(problems({SOURCE: quiet}), [])

    def test_upward_include(self):
        found = problems({HEADER: header('#include "samestep/space.h"\n'), "include/samestep/space.h": header("")})
        self.assertEqual(len(found), 1)
        self.assertRegex(found[0], r"^include/samestep/body\.h:2: \[upward-include\] .*'src/dynamics/' includes 'src/world/'")

    def test_downward_include(self):
        files = {"include/samestep/space.h": header("#include <samestep/body.h>\n"), HEADER: header("")}
        self.assertEqual(problems(files), [])

    def test_number_includes_nothing_above_it(self):
        files = {"fixed/include/samestep/fixed.h": header('#include "samestep/scalar.h"\n'),
                 "include/samestep/scalar.h": header("")}
        self.assertRegex("".join(problems(files)), r"\[upward-include\]")

    def test_folder_below_a_folder_is_on_its_layer(self):
        files = {"src/solver/kernels/x86/a.h": header('#include "solver/soft_step/b.h"\n'),
                 "src/solver/soft_step/b.h": header("")}
        self.assertRegex("".join(problems(files)), r"kernels/x86/a\.h:2: \[upward-include\]")

    def test_public_header_is_on_the_layer_of_its_source(self):
        files = {"src/contacts/arbiter.cpp": "", "include/samestep/arbiter.h": header('#include "samestep/body.h"\n'),
                 HEADER: header("")}
        self.assertEqual(problems(files), [])

    def test_public_header_without_a_source_is_named_in_the_table(self):
        self.assertRegex("".join(problems({"include/samestep/nowhere.h": header("")})), r"\[layer\]")
        found = problems({"include/samestep/vector.h": header("")})
        self.assertFalse(any("[layer]" in line for line in found), found)

    def test_name_without_a_folder_is_stale(self):
        with tempfile.TemporaryDirectory() as folder:
            check = source_check.Check(folder, source_check.Layers("src/base/\nsrc/gone/ : lost\n"))
            (Path(folder) / "src/base").mkdir(parents=True)
            (Path(folder) / "src/base/error.cpp").write_text("")
            check.check_table()
            self.assertEqual([line.split("'")[1] for line in check.problems], ["lost"])

    def test_folder_of_too_many_files(self):
        files = {f"src/dynamics/{letter}.cpp": "" for letter in "abcdefghijklmnopqrst"}
        self.assertRegex("".join(problems(files)), r"src/dynamics:1: \[folder\] 21 files")

    def test_two_headers_that_include_each_other(self):
        files = {HEADER: header('#include "samestep/shape.h"\n'),
                 "include/samestep/shape.h": header('#include "samestep/body.h"\n')}
        self.assertRegex("".join(problems(files)), r"\[include-cycle\] .*body\.h -> .*shape\.h -> .*body\.h")


if __name__ == "__main__":
    unittest.main()
