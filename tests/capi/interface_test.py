#!/usr/bin/env python3
"""Checks that a shared library of the C interface shows exactly the functions that capi/samestep.json lists, that the
file is what the header says, and that each function is documented.

Usage: interface_test.py LIBRARY
"""

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def shown(library):
    """Functions and data that the library defines for others."""
    listed = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    return {line.split()[-1] for line in listed.splitlines()}


def main():
    if subprocess.run([sys.executable, ROOT / "scripts/c-interface", "--check"]).returncode != 0:
        return 1
    description = json.loads((ROOT / "capi/samestep.json").read_text(encoding="utf-8"))
    listed = {function["name"] for function in description["functions"]}
    # Symbols that a sanitizer or the linker adds have no name of ours.
    found = {name for name in shown(sys.argv[1]) if not name.startswith("__")}
    for name in sorted(listed - found):
        print(f"{name} is in the header, and not in the library")
    for name in sorted(found - listed):
        print(f"{name} is in the library, and not in the header")
    bare = [part["name"] for kind in ("functions", "structures", "constants", "callbacks", "opaque")
            for part in description[kind] if not part["about"]]
    for name in bare:
        print(f"{name} has no comment")
    print(f"{len(listed)} functions, {len(description['structures'])} structures, {len(description['constants'])} constants")
    return 1 if listed != found or bare else 0


if __name__ == "__main__":
    sys.exit(main())
