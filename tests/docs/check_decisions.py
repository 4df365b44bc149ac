#!/usr/bin/env python3
"""The records of docs/decisions: check_decisions.py [FOLDER]. Each is NNNN-name.md with a number of its own, which its
heading repeats, and says its status and date in its first lines. A record that replaces one is there."""
import os
import re
import sys

STATUS = re.compile(
    r"^\**Status:\**\s*(in force|replaced by \[?(\d{4})|withdrawn)\b[^\n]*\d{4}-\d\d-\d\d", re.M
)
HEAD_LINES = 8


def problems(folder):
    seen = {}
    for name in sorted(os.listdir(folder)):
        match = re.fullmatch(r"(\d{4})-[a-z0-9][a-z0-9-]*\.md", name)
        if not match:
            yield name, "is not called NNNN-name.md"
            continue
        number = match.group(1)
        if number in seen:
            yield name, "has the number of " + seen[number]
        seen[number] = name
        with open(os.path.join(folder, name), encoding="utf-8") as file:
            head = "".join(file.readlines()[:HEAD_LINES])
        if not re.match(r"# %s\b" % number, head):
            yield name, "has another number in its heading"
        status = STATUS.search(head)
        if not status:
            yield name, "does not say its status and date in its first lines"
        elif status.group(2) and not any(n.startswith(status.group(2) + "-") for n in os.listdir(folder)):
            yield name, "is replaced by a record that is not there"


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.join(here, "..", "..", "docs", "decisions")
    found = list(problems(folder))
    for name, what in found:
        print("%s: %s" % (name, what))
    count = len(os.listdir(folder))
    print("%d records, %d problems" % (count, len(found)))
    sys.exit(1 if found or count == 0 else 0)


main()
