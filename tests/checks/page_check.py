#!/usr/bin/env python3
"""Checks that a page shows a program word for word.

Usage: page_check.py PAGE PROGRAM      exits 1 if none of the page's code blocks is the program.
"""

import re
import sys
from pathlib import Path


def blocks(page):
    return re.findall(r"^```cpp\n(.*?)^```$", page, re.S | re.M)


def main():
    page, program = (Path(name).read_text(encoding="utf-8") for name in sys.argv[1:3])
    if program in blocks(page):
        return 0
    print(f"{sys.argv[1]} does not show {sys.argv[2]} as it is; copy it there")
    return 1


if __name__ == "__main__":
    sys.exit(main())
