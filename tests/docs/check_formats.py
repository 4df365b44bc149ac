#!/usr/bin/env python3
"""The tables of docs/formats.md: check_formats.py [FILE]. Each row has a feature, an answer and tests: `TEST` of the build,
of tests/*/CMakeLists.txt, with words of one of its cases behind it (`TEST`: WORDS) where it has cases. The table of notes has
those of src/import/note_texts.hpp, word for word."""
import glob
import os
import re
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def cases_of(folder, sources):
    cases = []
    for source in re.findall(r"(?<![\w/])\w+\.cpp", sources):
        cases += re.findall(r'TEST_CASE\(\s*"((?:[^"\\]|\\.)*)"', read(os.path.join(folder, source)))
    return cases


def known_tests():
    """The names of the tests, and of each the names of its cases; None for those that have none."""
    tests = {}
    for path in glob.glob(os.path.join(ROOT, "tests", "*", "CMakeLists.txt")):
        text = read(path)
        for name, sources in re.findall(r"tegotae_add_test\((\w+)([^)]*)\)", text):
            tests[name] = cases_of(os.path.dirname(path), sources)
        fuzzed = re.findall(r"tegotae_add_fuzz_target\((\w+)", text)
        for formats in re.findall(r"foreach\(format ([^)]*)\)", text):
            fuzzed += formats.split()
        tests.update(("fuzz_" + name, None) for name in fuzzed)
    return tests


def fault_of(test, words, known):
    if test not in known:
        return "no test %s" % test
    if known[test] is None:
        return "%s has no cases" % test if words else None
    if not words:
        return "no words of a case of %s" % test
    return None if any(words in case for case in known[test]) else "no case of %s has \"%s\"" % (test, words)


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
    for number, line in enumerate(read(path).splitlines(), 1):
        if not line.startswith("|") or line.startswith("|---") or line.startswith(("| feature", "| note")):
            continue
        rows += 1
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        first_cells.add(tuple(cells[:2]))
        # Words may have commas in them; a test begins with a backtick.
        tests = re.findall(r"`([^`]*)`(?:: (.*?))?(?:, (?=`)|$)", cells[-1])
        wrong = [fault for fault in (fault_of(test, words, known) for test, words in tests) if fault]
        if len(cells) != 3 or not all(cells) or not tests or wrong:
            faults += 1
            print("%s:%d: %s" % (path, number, "; ".join(wrong) or "not feature, answer, tests"))
    for note in sorted(set(notes()) - first_cells):
        faults += 1
        print("%s: no row | %s | %s |" % ((path,) + note))
    print("%d rows, %d faults" % (rows, faults))
    sys.exit(1 if faults or rows == 0 else 0)


main()
