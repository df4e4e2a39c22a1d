#!/usr/bin/env python3
"""trace_check.py finds each way in which the table and the sources can disagree."""

import tempfile
import unittest
from pathlib import Path

import trace_check

HEADER_LINE = "module,name,symbol,header,test,status,note\n"
ROW = "Body,bodySetMass,Body::setMass,include/body.h,Body.SetsMass,done,\n"
SOURCES = {
    "include/body.h": "class Body {\n  /// kg. MIS: bodySetMass, bodyWeigh\n  void setMass(S mass);\n};\n"
                      "/// MIS: vectAdd\ntemplate <Scalar S>\nVector operator+(Vector a, Vector b);\n",
    "tests/dynamics/body_test.cpp": "TYPED_TEST(Body,\n           SetsMass) {}\n// TEST(Body, Gone)\n",
}


def problems(table, expected="Body,bodySetMass\n", sources=None):
    """What the check says of this table, as "name: message" lines."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in {**SOURCES, **(sources or {}), "mis.csv": table, "expected.txt": expected}.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        found = trace_check.check(root / "mis.csv", root / "expected.txt", trace_check.Sources(root))
        return [f"{name}: {message}" for _, name, message in found]


class TraceCheck(unittest.TestCase):
    def assert_problem(self, pattern, table, **others):
        found = problems(table, **others)
        self.assertEqual(len(found), 1, found)
        self.assertRegex(found[0], pattern)

    def test_right_table_has_no_problem(self):
        self.assertEqual(problems(HEADER_LINE + ROW), [])

    def test_missing_row(self):
        self.assert_problem("bodySetMass: no row of module Body", HEADER_LINE)

    def test_row_twice(self):
        self.assert_problem("twice", HEADER_LINE + ROW + ROW)

    def test_unknown_name(self):
        self.assert_problem("no such name", HEADER_LINE + ROW + ROW.replace("bodySetMass", "bodyGetMas"))

    def test_other_header_line(self):
        self.assert_problem("header line", HEADER_LINE.replace("note", "notes") + ROW)

    def test_symbol_that_is_only_in_a_comment(self):
        self.assert_problem("'bodyWeigh' of symbol", HEADER_LINE + ROW.replace("Body::setMass", "bodyWeigh"))

    def test_header_that_does_not_exist(self):
        self.assert_problem("no header", HEADER_LINE + ROW.replace("include/body.h", "include/none.h"))

    def test_header_that_does_not_name_the_access_program(self):
        self.assert_problem("says 'MIS: bodySetMass'", HEADER_LINE + ROW,
                            sources={"include/body.h": "class Body { void setMass(S mass); };\n"})

    def test_test_that_is_only_in_a_comment(self):
        self.assert_problem("no test 'Body.Gone'", HEADER_LINE + ROW.replace("SetsMass", "Gone"))

    def test_no_test(self):
        self.assert_problem("no test$", HEADER_LINE + ROW.replace("Body.SetsMass", ""))

    def test_open_row(self):
        self.assert_problem("status is 'open'", HEADER_LINE + ROW.replace("done", "open"))

    def test_not_applicable_needs_a_reason(self):
        row = "Body,bodySetMass,,,,not applicable,"
        self.assert_problem("no reason", HEADER_LINE + row + "\n")
        self.assertEqual(problems(HEADER_LINE + row + "memory management\n"), [])

    def test_tags_lead_to_the_declaration_below_them(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "include").mkdir()
            (Path(folder) / "include/body.h").write_text(SOURCES["include/body.h"])
            tags = trace_check.Sources(folder).tags()
        self.assertEqual(tags["bodySetMass"], ("Body::setMass", "include/body.h"))
        self.assertEqual(tags["vectAdd"], ("operator+", "include/body.h"))


if __name__ == "__main__":
    unittest.main()
