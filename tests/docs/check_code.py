#!/usr/bin/env python3
"""Code in the documents is code that is compiled or run: every ```cpp, ```c and ```python block of README.md and docs/*.md
(but docs/api.md, which is made of the headers, and docs/python.md, whose blocks tests/python runs) stands, line by line
and in this order, in one of apps/examples or in snippets.cpp. A line `…` stands for lines left out."""
import glob
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
BLOCK = re.compile(r"^```(cpp|c|python)\n(.*?)^```$", re.M | re.S)


def lines(text):
    return [line.strip() for line in text.splitlines() if line.strip()]


def within(block, source):
    """Whether the lines of `block` are a subsequence of `source`, in one piece between two lines `…`."""
    at = 0
    for piece in re.split(r"^\s*…\s*$", block, flags=re.M):
        wanted = lines(piece)
        found = next((i for i in range(at, len(source) - len(wanted) + 1) if source[i : i + len(wanted)] == wanted), None)
        if found is None:
            return False
        at = found + len(wanted)
    return True


def main():
    sources = {}
    for path in sorted(glob.glob(os.path.join(ROOT, "apps", "examples", "*.*"))) + [os.path.join(HERE, "snippets.cpp")]:
        with open(path, encoding="utf-8") as file:
            sources[path] = lines(file.read())
    count, bad = 0, []
    for page in [os.path.join(ROOT, "README.md")] + sorted(glob.glob(os.path.join(ROOT, "docs", "*.md"))):
        if os.path.basename(page) in ("api.md", "python.md"):
            continue
        with open(page, encoding="utf-8") as file:
            for _, block in BLOCK.findall(file.read()):
                count += 1
                if not any(within(block, source) for source in sources.values()):
                    bad.append("%s: this code is in no program that is built:\n%s" % (page, block))
    if bad or count == 0:
        sys.exit("\n".join(bad) or "no code found")
    print("%d blocks" % count)


main()
