#!/usr/bin/env python3
"""Rejects what breaks determinism or the layering, and leftovers, with the replacement in the message.

Usage: source_check.py ROOT      prints FILE:LINE: what is wrong; exits 1 if anything is.
"""

import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ENGINE_FOLDERS = ("include", "src", "fixed", "replay", "lockstep", "capi")
# Looked through for leftovers and machine paths only.
OTHER_FOLDERS = ("tests", "bench", "fuzz", "examples", "scripts", "cmake", "docs")
CODE_SUFFIXES = (".h", ".cpp")
TEXT_SUFFIXES = CODE_SUFFIXES + (".txt", ".cmake", ".py", ".md", ".sh", "")
MAX_COLUMNS = 110
# Files in one folder of sources.
MAX_FILES = 20
MAX_FUNCTION_LINES = 70
# Share of the comments that may begin with a fragment; and the number that a small tree may have.
MAX_FRAGMENTS = 0.04
FEW_FRAGMENTS = 1

# Where the square root may be taken, the one function of libm that IEEE-754 rounds correctly: the double
# one, and the estimate behind the exact integer one.
SQRT_FILES = ("include/samestep/math.h", "fixed/include/samestep/way_root.h")

LIBM = (
    "a?(?:sin|cos|tan)h?|atan2|exp|exp2|expm1|log|log2|log10|log1p|logb|ilogb|pow|cbrt|hypot|fma|lerp|"
    "fmod|remainder|remquo|floor|ceil|trunc|l?l?round|l?l?rint|nearbyint|ldexp|frexp|modf|scalbl?n|"
    "nextafter|nexttoward|fmin|fmax|fdim|fabs|copysign|erfc?|[lt]gamma|isnan|isinf|isfinite|signbit"
)
# Ours are called unqualified, so only names that we do not define are caught without std::.
LIBM_BARE = "a?(?:sin|cos|tan)h?|expm1|log|log10|log1p|cbrt|hypot|fma|fmod|ldexp|frexp|floor|ceil"
NOT_QUALIFIED = r"(?<![\w.:>~])"
ORDERING = "sort|nth_element|partial_sort(?:_copy)?|partition|make_heap|push_heap|pop_heap|sort_heap"
UNSIZED = (
    r"(?:std::)?(?:size_t|ptrdiff_t|u?int_fast\d+_t|u?intptr_t|wchar_t)|"
    r"(?:unsigned\s+|signed\s+)?long(?:\s+(?:unsigned|signed|int|long))*"
)

# Public headers that are there for users alone: the specification names these containers as modules.
USERS_HEADERS = ("array", "hash_set")


class Rule:
    """One forbidden pattern, looked for line by line in code without comments and strings.

    `marker`: a comment with this text on the line or the line before, followed by a reason, permits it.
    """

    def __init__(self, name, pattern, message, marker=None, exempt=()):
        self.name = name
        self.pattern = re.compile(pattern)
        self.message = message
        self.marker = marker
        self.exempt = exempt


RULES = [
    Rule("unordered", r"\bunordered_(?:map|set|multimap|multiset)\b",
         "order of an unordered container differs between libraries; use HashSet (insertion order) or a "
         "sorted vector"),
    Rule("libm", rf"\bstd::(?:{LIBM})\s*\(|(?<![\w>:])::(?:{LIBM})\s*\(|__builtin_(?:{LIBM})[fl]?\s*\(|"
         rf"{NOT_QUALIFIED}(?:{LIBM_BARE})\s*\(",
         "libm differs between platforms; use samestep::sincos, atan2, exp, log2, pow (math.h, fixed_math.h), "
         "or compare and select"),
    Rule("cmath", r"#\s*include\s*<(?:cmath|math\.h|complex|tgmath\.h|ctgmath)>",
         "libm differs between platforms; include <samestep/math.h>", exempt=SQRT_FILES),
    Rule("sqrt", r"\bstd::sqrt\w?\s*\(|(?<![\w>:])::sqrt\w?\s*\(|__builtin_sqrt\w?\s*\(|_mm\w*_sqrt_\w+",
         "call samestep::sqrt, so that there is one square root", exempt=SQRT_FILES),
    Rule("sort", rf"\bstd::(?:ranges::)?(?:{ORDERING})\s*\(|\bstd::priority_queue\b",
         "order of equal elements differs between libraries; use std::stable_sort, or say in a comment "
         "'// total order: ...' why no two elements are equal", marker="total order:"),
    Rule("clock", r"\bstd::chrono\b|#\s*include\s*<(?:chrono|ctime|time\.h|sys/time\.h)>|"
         r"\b(?:clock_gettime|gettimeofday|__rdtsc|std::time|std::clock)\s*\(|\b(?:steady|system)_clock\b",
         "time is no input of the engine; count ticks, or say '// not in results: ...' where it is only shown",
         marker="not in results:"),
    Rule("random", r"\brandom_device\b|\bstd::\w+_distribution\b|\bdefault_random_engine\b|"
         r"\bstd::(?:shuffle|sample|rand|srand)\b|\brandom_shuffle\b|" + NOT_QUALIFIED + r"s?rand\s*\(",
         "differs between machines or libraries; draw from std::mt19937_64's raw numbers or take a seed"),
    Rule("address", r"\bu?intptr_t\b|\bstd::(?:hash|less|greater|owner_less)<[^<>]*\*\s*>|\bhash_code\s*\(",
         "an address differs from run to run; use an id or index, or say '// not in results: ...'",
         marker="not in results:"),
    Rule("std-hash", r"\bstd::hash\b",
         "std::hash differs between libraries and word sizes; write the 64-bit hash out, or say "
         "'// not in results: ...' where it serves users only", marker="not in results:"),
    Rule("parallel-sum", r"\bstd::(?:transform_)?reduce\s*\(|\bstd::execution\b",
         "order of the sum is not stated; write the loop, or use std::accumulate"),
    Rule("decimal", r"\b(?:std::)?(?:stod|stof|stold|strto(?:d|f|ld)|atof|sscanf)\s*\(",
         "goes by locale and through libm; use parseDecimal"),
    Rule("long-double", r"\blong\s+double\b", "its width differs between platforms; use double or Fixed"),
    Rule("macro", r"#\s*define\s+\w+\(", "no function-like macros; write a constexpr function or template"),
]
HEAVY_HEADERS = re.compile(
    r"#\s*include\s*<(functional|memory|iostream|ranges|regex|sstream|fstream|iomanip|random|thread|map|set)>")
# What every client compiles includes none of these, whose parsing takes longer than all of our own headers.
CLIENT_HEADER = Path("include/samestep/space.h")
NOT_FOR_CLIENTS = re.compile(r"#\s*include\s*<(string|string_view|algorithm|optional|\w+intrin\.h|arm_neon\.h)>")
LEFTOVER = re.compile(r"\b(?:FIX" + r"ME|TO" + r"DO|XX" + r"X|HA" + r"CK)\b")
SKIPPED_TEST = re.compile(r"\bGTEST_" + r"SKIP\b|\bDISA" + r"BLED_")
MACHINE_PATH = re.compile(r"(?<![\w.}\)])/(?:work|root|home|Users|tmp|mnt|scratch)/\w")
# Words that begin a part of a sentence, where a comment should name its subject.
FRAGMENT = re.compile(
    r"(?:What|Of|Whether|How|Which|Who|Whose|Whoever|Whatever|Why|The same|Asked|Called|Told|Thrown|Seen|Also|Nor|"
    r"Those (?:that|of|who|which|in|up))\b")
# These begin a sentence, too; it then has a word of the second kind.
PREPOSITION = re.compile(
    r"(?:Where|As|By|For|From|To|With|Without|In|At|On|Out|Against|Along|Up|Between|Behind|Beyond|While|Among|Within|"
    r"Before|After|Until|Since|Unless|Like|Over|Under|Not|Only|When|If|Below|Above|Beside|Across|Through|Per)\b")
VERB = re.compile(r"\b(?:is|are|was|were|has|have|had|does|do|did|can|may|must|shall|will|would|could|should|needs?|"
                  r"cannot|it|they|there|he|who|that|which)\b|n't\b|\bcounts?\b|\bstands?\b|\bcoincide\b|\btakes?\b")
# A clause with one of these needs another clause, behind a comma.
SUBORDINATE = re.compile(r"(?:Where|As|While|When|If|Unless|Until|Since)\b[^,:]*$")
NO_PROSE = re.compile(r"SPDX|namespace|extern|@|MIS|clang-format|\W*$")
# What the formatter makes of a line that it misreads, and several references in one declaration.
MANGLED = re.compile(r"[\w)>]\)&&\w|\w&\w+ = .*, &\w+ =")
INCLUDE = re.compile(r'#\s*include\s*([<"])([^>"]+)[>"]')


def split_comments(text):
    """The code with comments and the insides of literals blanked, and the comment text of each line."""
    code = []
    comments = [[] for _ in range(text.count("\n") + 1)]
    line = 0
    token = re.compile(
        r'//[^\n]*|/\*.*?\*/|R"(?P<tag>[^(\s]*)\(.*?\)(?P=tag)"|"(?:\\.|[^"\\\n])*"|'
        r"(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'", re.S)
    end = 0
    for match in token.finditer(text):
        before = text[end:match.start()]
        code.append(before)
        line += before.count("\n")
        found = match.group()
        if found.startswith("/"):
            for offset, part in enumerate(found.split("\n")):
                comments[line + offset].append(part)
            code.append(re.sub(r"[^\n]", " ", found))
        elif text[:match.start()].rpartition("\n")[2].lstrip().startswith("#"):
            code.append(found)  # the name of an included file
        else:
            code.append(found[0] + re.sub(r"[^\n]", " ", found[1:-1]) + found[-1])
        line += found.count("\n")
        end = match.end()
    code.append(text[end:])
    return "".join(code).split("\n"), [" ".join(parts) for parts in comments]


class Layers:
    """The table of layers.txt: folders from the lowest to the highest, and where each public header belongs."""

    PUBLIC = "include/samestep"

    def __init__(self, table):
        self.names = []
        self.folders = {}
        self.headers = {}
        for row in table.splitlines():
            folders, _, headers = row.split("#")[0].partition(":")
            if not folders.split():
                continue
            for folder in folders.split():
                self.folders[folder.rstrip("/")] = len(self.names)
            for header in headers.split():
                self.headers[header] = len(self.names)
            self.names.append(folders.split()[-1])

    def of(self, root, path):
        """Layer of a file, or None where no folder of the table has it."""
        if path.parent.as_posix() == self.PUBLIC:
            return self.of_header(root, path.stem)
        for folder in path.parents:
            if folder.as_posix() in self.folders:
                return self.folders[folder.as_posix()]
        return None

    def of_header(self, root, stem):
        """Layer of a public header: that of the source with its name, or the one named in the table."""
        if stem in self.headers:
            return self.headers[stem]
        for folder, layer in self.folders.items():
            if any((root / folder).glob(stem + ".cpp")) or any((root / folder).glob(stem + "_*.cpp")):
                return layer
        return None

    def stale(self, root):
        """Names of the table that nothing exists for."""
        for folder, layer in self.folders.items():
            if layer not in self.headers.values() and not any(path.suffix in CODE_SUFFIXES for path in (root / folder).rglob("*")):
                yield folder + "/"
        for header in self.headers:
            if not (root / self.PUBLIC / (header + ".h")).is_file():
                yield header


class Check:
    def __init__(self, root, layers=None):
        self.root = Path(root)
        self.layers = layers or Layers((HERE / "layers.txt").read_text())
        self.problems = []
        self.includes = {}

    def report(self, path, line, rule, message):
        self.problems.append(f"{path}:{line + 1}: [{rule}] {message}")

    def files(self, folders, suffixes):
        for folder in folders:
            for path in sorted((self.root / folder).rglob("*")):
                if path.is_file() and path.suffix in suffixes and "__pycache__" not in path.parts:
                    yield path.relative_to(self.root)

    def run(self):
        engine = []
        for path in self.files(ENGINE_FOLDERS, CODE_SUFFIXES):
            if "tests" in path.parts:
                continue
            engine.append(path)
            text = self.read(path)
            code, comments = split_comments(text)
            self.check_rules(path, code, comments)
            if path.suffix == ".h":
                self.check_header(path, code, comments)
            self.check_includes(path, code)
            self.check_shape(path, code)
        self.check_cycles()
        self.check_client()
        self.check_folders()
        self.check_dead_headers()
        self.check_comments()
        for path in self.files(ENGINE_FOLDERS + OTHER_FOLDERS, TEXT_SUFFIXES):
            self.check_leftovers(path, self.read(path))
        for path in sorted(self.root.iterdir()):
            if path.is_file() and path.suffix in (".md", ".txt", ".json"):
                self.check_leftovers(path.relative_to(self.root), self.read(path.name))
        return engine

    def read(self, path):
        return (self.root / path).read_text(encoding="utf-8", errors="replace")

    def check_rules(self, path, code, comments):
        for rule in RULES:
            if path.as_posix() in rule.exempt:
                continue
            for number, line in enumerate(code):
                if rule.pattern.search(line) and not permitted(rule.marker, code, comments, number):
                    self.report(path, number, rule.name, rule.message)

    def check_header(self, path, code, comments):
        if not any(re.match(r"\s*#\s*(?:pragma\s+once|ifndef\s+\w+)", line) for line in code):
            self.report(path, 0, "guard", "no include guard; begin with #pragma once")
        if "include" not in path.parts:
            return
        for number, line in enumerate(code):
            heavy = HEAVY_HEADERS.search(line)
            if heavy:
                self.report(path, number, "heavy-header",
                            f"<{heavy.group(1)}> in a public header makes every user compile it; move it to the "
                            "source, or take a template parameter, span or plain function pointer")
        for number, member in data_members(code):
            if re.search(rf"\b(?:{UNSIZED})\b", member) and not permitted("not state:", code, comments, number):
                self.report(path, number, "unsized-member",
                            "its width differs between platforms; use std::int32_t, std::uint64_t, ..., or say "
                            "'// not state: ...' why it is never saved or hashed")

    def check_includes(self, path, code):
        own = self.layers.of(self.root, path)
        if own is None:
            self.report(path, 0, "layer", "in no folder of the table of layers; move it, or add the folder to tests/checks/layers.txt")
            return
        for number, line in enumerate(code):
            match = INCLUDE.search(line)
            target = self.resolve(path, match.group(2)) if match else None
            if target is None:
                continue
            self.includes.setdefault(path, []).append((number, target))
            other = self.layers.of(self.root, target)
            if other is not None and other > own:
                self.report(path, number, "upward-include",
                            f"layer '{self.layers.names[own]}' includes '{self.layers.names[other]}' above it; "
                            "name it by id, or move what is needed down")

    def resolve(self, path, name):
        """The file of this project that an include names, or None."""
        beside = [path.parent / name]
        searched = [Path(folder) / name for folder in
                    ("include", "fixed/include", "replay/include", "lockstep/include", "capi/include", "src", "replay", "lockstep")]
        for candidate in beside + searched:
            if (self.root / candidate).is_file():
                return candidate
        return None

    def check_cycles(self):
        done = set()

        def visit(path, trail):
            if path in trail:
                return [*trail[trail.index(path):], path]
            if path in done:
                return None
            for number, target in self.includes.get(path, []):
                cycle = visit(target, [*trail, path])
                if cycle:
                    return cycle
            done.add(path)
            return None

        for path in sorted(self.includes):
            cycle = visit(path, [])
            if cycle:
                self.report(path, 0, "include-cycle", " -> ".join(map(str, cycle)) + "; name one of them by id")
                return

    def check_client(self):
        """Standard headers in what samestep/space.h includes."""
        reached, waiting = {CLIENT_HEADER}, [CLIENT_HEADER]
        while waiting:
            for _, target in self.includes.get(waiting.pop(), []):
                if target not in reached:
                    reached.add(target)
                    waiting.append(target)
        for path in sorted(reached):
            if not (self.root / path).is_file():
                continue
            for number, line in enumerate(split_comments(self.read(path))[0]):
                slow = NOT_FOR_CLIENTS.search(line)
                if slow:
                    self.report(path, number, "client-header",
                                f"<{slow.group(1)}> is compiled by everybody who includes samestep/space.h; move what "
                                "needs it to a header of its own or to the source")

    def check_table(self):
        for name in self.layers.stale(self.root):
            self.report(Path("tests/checks/layers.txt"), 0, "stale-layer", f"'{name}' is named and does not exist")

    def check_folders(self):
        for folder in sorted({path.parent for path in self.files(("src", "replay"), CODE_SUFFIXES)}):
            count = sum(1 for path in (self.root / folder).iterdir() if path.suffix in CODE_SUFFIXES)
            if count > MAX_FILES:
                self.report(folder, 0, "folder", f"{count} files, {MAX_FILES} at most; give a subject of its own a folder")

    def check_shape(self, path, code):
        for number, line in enumerate(code):
            if MANGLED.search(line):
                self.report(path, number, "mangled", "the formatter misread this; write one declaration a line, or "
                            "parentheses around what is compared")
        for start, end in functions(code):
            if end - start + 1 > MAX_FUNCTION_LINES:
                self.report(path, start, "long-function", f"{end - start + 1} lines, {MAX_FUNCTION_LINES} at most; "
                            "make it a list of named steps")

    def check_dead_headers(self):
        """Public headers that no other file of the product includes are interface without use."""
        used = {target for path, found in self.includes.items() for _, target in found
                if path.stem.split("_test")[0] != target.stem or path.suffix == ".h"}
        for path in self.files(("include",), (".h",)):
            own = list((self.root / "src").rglob(path.stem + "*.cpp"))
            if path not in used and not own and path.stem not in USERS_HEADERS:
                self.report(path, 0, "dead-header", "no file of the product includes it; remove it, or name it in "
                            "USERS_HEADERS with the reason")

    def check_comments(self):
        """Comments that begin in the middle of a sentence, told of where they are more than a few."""
        found, blocks = [], 0
        for path in self.files(ENGINE_FOLDERS + OTHER_FOLDERS, CODE_SUFFIXES):
            for number, text in comment_blocks(self.read(path)):
                blocks += not NO_PROSE.match(text)
                if is_fragment(text):
                    found.append((path, number, text))
        if len(found) <= max(FEW_FRAGMENTS, MAX_FRAGMENTS * blocks):
            return
        for path, number, text in found:
            self.report(path, number, "fragment", f"'{text[:40]}...' begins in the middle of a sentence; name the thing "
                        "by the field's word, then the reason")

    def check_leftovers(self, path, text):
        is_code = path.suffix in CODE_SUFFIXES
        lines = text.split("\n")
        for number, line in enumerate(lines):
            if LEFTOVER.search(line):
                self.report(path, number, "leftover", "finish it, or file an issue and say in the code what holds")
            if is_code and SKIPPED_TEST.search(line):
                self.report(path, number, "skipped-test", "a test runs or is removed")
            # The message of an #error cannot be broken.
            if is_code and len(line) > MAX_COLUMNS and "#error" not in lines[number - 1]:
                self.report(path, number, "long-line", f"{len(line)} columns, {MAX_COLUMNS} at most")
            if MACHINE_PATH.search(line):
                self.report(path, number, "machine-path", "a path of one machine; make it relative, or a mktemp")


def comment_blocks(text):
    """(line, text) of each run of line comments, and of each comment behind code."""
    first, parts = 0, []
    for number, line in enumerate(text.split("\n") + [""]):
        whole = re.match(r"\s*//[/!]?<?\s?(.*)$", line)
        if whole:
            if not parts:
                first = number
            parts.append(whole.group(1))
            continue
        if parts:
            yield first, " ".join(parts)
            parts = []
        behind = re.search(r"[;,{}]\s+///?<?\s?(.*)$", line)
        if behind:
            yield number, behind.group(1)


def is_fragment(text):
    """Whether a comment begins in the middle of a sentence."""
    if NO_PROSE.match(text):
        return False
    sentence = re.match(r".*?[.](?=\s|$)|.*", text, re.S).group()
    return bool(FRAGMENT.match(text) or SUBORDINATE.match(sentence) or
                (PREPOSITION.match(text) and not VERB.search(sentence)))


def functions(code):
    """(first line, last line) of each function with a body that is no part of another."""
    scopes = []  # (kind, line) with kind "space" (namespace or class), "function" or "other"
    pending, start = "", 0
    for number, line in enumerate(code):
        if line.lstrip().startswith("#"):
            continue
        for character in line + "\n":
            if not pending.strip():
                start = number
            if character == "{":
                scopes.append((scope_of(pending, scopes), start))
                pending = ""
            elif character == "}":
                kind, first = scopes.pop() if scopes else ("other", number)
                if kind == "function":
                    yield first, number
                pending = ""
            elif character == ";" or (character == ":" and re.fullmatch(r"\s*(?:public|private|protected)\s*", pending)):
                pending = ""
            else:
                pending += character


def scope_of(declaration, scopes):
    """What a brace behind this text opens, within the scopes around it, for functions()."""
    if any(outer != "space" for outer, _ in scopes):
        return "other"
    text = strip_template(declaration)
    if re.search(r"\b(?:namespace|class|struct|union|enum|extern)\b", text) and ")" not in text:
        return "space"
    is_function = ")" in text and "=" not in text.split("(")[0].replace("operator=", "")
    return "function" if is_function else "other"


def permitted(marker, code, comments, number):
    """Whether a comment with the marker and a reason stands on this line or right above it."""
    if marker is None:
        return False
    near = [comments[number]]
    above = number - 1
    while above >= 0 and comments[above]:
        near.insert(0, comments[above])
        if code[above].strip():
            break
        above -= 1
    return re.search(re.escape(marker) + r"\s*\w", " ".join(near)) is not None


def data_members(code):
    """(line, declaration) for each data member declared directly in a class body."""
    scopes = []  # "class", "value" (a member's initial value in braces) or "other"
    pending = ""
    start = 0
    for number, line in enumerate(code):
        if line.lstrip().startswith("#"):
            continue
        for character in line + "\n":
            inside = scopes[-1] if scopes else "other"
            if inside == "value" and character not in "{}":
                continue
            if not pending.strip():
                start = number
            if character == "{":
                scopes.append(scope_after(pending, inside))
                if scopes[-1] != "value":
                    pending = ""
            elif character == "}":
                if scopes and scopes.pop() != "value":
                    pending = ""
            elif character == ";":
                if inside == "class" and is_data(pending):
                    yield start, pending
                pending = ""
            elif character == ":" and re.fullmatch(r"\s*(?:public|private|protected)\s*", pending):
                pending = ""
            else:
                pending += character


def scope_after(declaration, inside):
    """What a brace behind this text opens."""
    text = re.sub(r"\balignas\s*\([^)]*\)", " ", strip_template(declaration))
    if inside == "value":
        return "value"
    if re.search(r"\b(?:class|struct|union)\b", text) and not re.search(r"\benum\b|\)", text):
        return "class"
    if inside == "class" and "(" not in text and not re.search(r"\b(?:enum|requires|operator)\b", text):
        return "value"
    return "other"


def strip_template(declaration):
    """A declaration without its leading template<...>, whose `class` names no class."""
    text = declaration.lstrip()
    if not text.startswith("template"):
        return declaration
    depth = 0
    for place, character in enumerate(text):
        depth += (character == "<") - (character == ">")
        if character == ">" and depth == 0:
            return strip_template(text[place + 1:])
    return text


def is_data(declaration):
    text = strip_template(declaration)
    if re.search(r"\b(?:static|using|typedef|friend|enum|operator|class|struct|extern|concept)\b", text):
        return False
    return "(" not in text.split("=")[0] and bool(re.search(r"\w\s+\*?\w+|>\s*\w+", text))


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else HERE.parents[1]
    check = Check(root)
    files = check.run()
    check.check_table()
    for problem in check.problems:
        print(problem)
    if not files:
        print("no source files found under", root)
        return 1
    print(f"{len(files)} engine files, {len(check.problems)} problems")
    return 1 if check.problems else 0


if __name__ == "__main__":
    sys.exit(main())
