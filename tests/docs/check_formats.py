#!/usr/bin/env python3
"""The tables of docs/formats.md: check_formats.py [FILE]. Each row has a feature, an answer and tests, and each of the
tests is one of the build's: of tests/*/CMakeLists.txt."""
import glob
import os
import re
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")


def known_tests():
    names = set()
    for path in glob.glob(os.path.join(ROOT, "tests", "*", "CMakeLists.txt")):
        with open(path, encoding="utf-8") as file:
            text = file.read()
        names.update(re.findall(r"tegotae_add_test\((\w+)", text))
        names.update("fuzz_" + name for name in re.findall(r"tegotae_add_fuzz_target\((\w+)", text))
        for formats in re.findall(r"foreach\(format ([^)]*)\)", text):
            names.update("fuzz_" + name for name in formats.split())
    return names


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "docs", "formats.md")
    known, rows, faults = known_tests(), 0, 0
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            if not line.startswith("|") or line.startswith("|---") or line.startswith("| feature"):
                continue
            rows += 1
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            tests = re.findall(r"`([^`]*)`", cells[-1])
            wrong = [name for name in tests if name not in known]
            if len(cells) != 3 or not all(cells) or not tests or wrong:
                faults += 1
                print("%s:%d: %s" % (path, number, "no tests %s" % wrong if wrong else "not feature, answer, tests"))
    print("%d rows, %d without a test" % (rows, faults))
    sys.exit(1 if faults or rows == 0 else 0)


main()
