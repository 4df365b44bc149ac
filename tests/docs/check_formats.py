#!/usr/bin/env python3
"""The tables of docs/formats.md: check_formats.py [FILE]. Each row has a feature, an answer and tests, and each of the
tests is one of the build's: of tests/*/CMakeLists.txt. The table of notes has those of src/import/note_texts.hpp, word
for word."""
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


def notes():
    """The first two cells of the row of each note."""
    with open(os.path.join(ROOT, "src", "import", "note_texts.hpp"), encoding="utf-8") as file:
        text = re.sub(r'"\s+"', "", file.read())
    for note in re.findall(r"constexpr NoteText \w+\{(.*?)\};", text, re.S):
        _, many, what, advice = re.findall(r'"([^"]*)"', note)
        yield many + ": " + what.replace("%s", "…"), advice


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "docs", "formats.md")
    known, rows, faults, first_cells = known_tests(), 0, 0, set()
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            if not line.startswith("|") or line.startswith("|---") or line.startswith(("| feature", "| note")):
                continue
            rows += 1
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            first_cells.add(tuple(cells[:2]))
            tests = re.findall(r"`([^`]*)`", cells[-1])
            wrong = [name for name in tests if name not in known]
            if len(cells) != 3 or not all(cells) or not tests or wrong:
                faults += 1
                print("%s:%d: %s" % (path, number, "no tests %s" % wrong if wrong else "not feature, answer, tests"))
    for note in sorted(set(notes()) - first_cells):
        faults += 1
        print("%s: no row | %s | %s |" % ((path,) + note))
    print("%d rows, %d faults" % (rows, faults))
    sys.exit(1 if faults or rows == 0 else 0)


main()
