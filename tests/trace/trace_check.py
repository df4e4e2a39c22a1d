#!/usr/bin/env python3
"""Checks mis.csv, which maps each access program and exception of the specification to our code.

Usage: trace_check.py [--fill] [ROOT]
  --fill   first writes the symbol and header of each row anew, from the declaration its tag stands at

A row fails when it is missing or twice there, its symbol is not in its header, or its test not in the tests.
An access program's header names it in a comment, as in "MIS: bodySetMass".
"""

import csv
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
COLUMNS = ["module", "name", "symbol", "header", "test", "status", "note"]
TEST_FOLDERS = ("tests", "fixed/tests", "replay/tests", "lockstep/tests")
TEST_MACRO = re.compile(r"\b(?:TYPED_)?TEST(?:_F|_P)?\s*\(\s*(\w+)\s*,\s*(\w+)\s*\)")
HEADER_FOLDERS = ("include", "src", "fixed/include", "replay/include", "lockstep/include")
EXCEPTIONS = "Exceptions"


class Sources:
    """The headers and tests of a tree, each read once."""

    def __init__(self, root):
        self.root = Path(root)
        self.headers = {}
        self.tests = set()
        for folder in TEST_FOLDERS:
            for path in sorted((self.root / folder).rglob("*.cpp")):
                text = re.sub(r"//[^\n]*|/\*.*?\*/", "", path.read_text(encoding="utf-8"), flags=re.S)
                self.tests.update(f"{suite}.{test}" for suite, test in TEST_MACRO.findall(text))

    def header(self, name):
        """(code, comments) of a header, or None where there is none of that name."""
        if name not in self.headers:
            path = self.root / name
            text = path.read_text(encoding="utf-8") if name and path.is_file() else None
            self.headers[name] = text and (re.sub(r"//[^\n]*|/\*.*?\*/", " ", text, flags=re.S),
                                           "\n".join(re.findall(r"//[^\n]*|/\*.*?\*/", text, flags=re.S)))
        return self.headers[name]

    def tags(self):
        """For each name behind "MIS:" in a header's comment, the symbol declared below it and the header."""
        found = {}
        for folder in HEADER_FOLDERS:
            for path in sorted((self.root / folder).rglob("*.h")):
                for names, symbol in tagged_symbols(path.read_text(encoding="utf-8")):
                    for name in names:
                        found.setdefault(name, (symbol, path.relative_to(self.root).as_posix()))
        return found


def tagged_symbols(text):
    """(names, symbol) for each comment block with "MIS:" and the declaration below it."""
    scope = ""
    block = []
    declaration = ""
    for line in text.split("\n"):
        words = line.strip()
        opened = re.match(r"(?:template\s*<[^;]*>\s*)?(?:class|struct)\s+(\w+)[^;]*\{", words)
        if opened and not line.startswith(" "):
            scope = opened.group(1) + "::"
        elif line.startswith("}"):
            scope = ""
        if words.startswith("//"):
            if declaration:
                block, declaration = [], ""
            block.append(words.lstrip("/ "))
            continue
        if not block or words.startswith(("template", "[[nodiscard]]")) and words.endswith((">", "]")):
            continue
        declaration += " " + words
        if not re.search(r"[;{}:]\s*$|\(", declaration):
            continue
        names = re.findall(r"\w+", "\n".join(block).partition("MIS:")[2])
        if names:
            yield names, symbol_of(declaration, scope)
        block, declaration = [], ""


def symbol_of(declaration, scope):
    text = re.sub(r"\[\[.*?\]\]", " ", declaration)
    match = re.search(r"(operator\s*(?:\(\)|\[\]|[^\s\w(]+)|\w+)\s*\(", text)
    if not match:
        match = re.search(r"(\w+)\s*(?:=[^;]*|\{[^;]*)?;", text) or re.search(r"(\w+)\s*[:{]", text)
    return ("" if " friend " in text else scope) + (match.group(1).replace(" ", "") if match else "?")


def problem_of(row, sources):
    """What is wrong with a row of the table, or None."""
    if row["status"] == "not applicable":
        return None if row["note"].strip() else "not applicable, but no reason in note"
    if row["status"] != "done":
        return f"status is '{row['status']}'; done, or 'not applicable' with a reason in note"
    header = sources.header(row["header"])
    if not header:
        return f"no header '{row['header']}'"
    code, comments = header
    if not row["symbol"]:
        return "no symbol"
    for part in row["symbol"].split("::"):
        pattern = re.escape(part) if part.startswith("operator") else rf"\b{re.escape(part)}\b"
        if not re.search(pattern, code):
            return f"'{part}' of symbol '{row['symbol']}' is not in {row['header']}"
    if row["module"] != EXCEPTIONS and not re.search(rf"\b{row['name']}\b", comments):
        return f"no comment in {row['header']} says 'MIS: {row['name']}'"
    tests = row["test"].split()
    if not tests:
        return "no test"
    for test in tests:
        if test not in sources.tests:
            return f"no test '{test}' in {', '.join(TEST_FOLDERS)}"
    return None


def check(table, expected, sources):
    """(place, name, what is wrong) for each problem of the table."""
    with open(table, newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file)
        if reader.fieldnames != COLUMNS:
            return [("line 1", "", f"the header line is not {','.join(COLUMNS)}")]
        rows = [(reader.line_num, row) for row in reader]
    wanted = [tuple(line.split(",")) for line in expected.read_text(encoding="utf-8").split()]
    problems = []
    seen = set()
    for line, row in rows:
        key = (row["module"], row["name"])
        if key in seen:
            problems.append((f"line {line}", row["name"], "twice"))
        elif key not in wanted:
            problems.append((f"line {line}", row["name"], "no such name in the specification"))
        else:
            message = problem_of(row, sources)
            if message:
                problems.append((f"line {line}", row["name"], message))
        seen.add(key)
    problems += [("missing", name, f"no row of module {module}") for module, name in wanted
                 if (module, name) not in seen]
    return problems


def fill(table, tags):
    """Writes symbol and header of the rows whose name has a tag; leaves the others and all else alone."""
    with open(table, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        if row["module"] != EXCEPTIONS and row["status"] != "not applicable" and row["name"] in tags:
            row["symbol"], row["header"] = tags[row["name"]]
    with open(table, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def main():
    arguments = sys.argv[1:]
    roots = [argument for argument in arguments if argument != "--fill"]
    sources = Sources(roots[0] if roots else HERE.parents[1])
    table = HERE / "mis.csv"
    if "--fill" in arguments:
        fill(table, sources.tags())
    problems = check(table, HERE / "expected.txt", sources)
    for place, name, message in problems:
        print(f"tests/trace/mis.csv: {place}: {name}: {message}")
    print(f"{len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
