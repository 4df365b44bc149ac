#!/usr/bin/env python3
"""Does what docs/tutorial.md says: run_tutorial.py BUILD_FOLDER.

Its ```sh blocks run in their order in one shell, in an empty home folder; every ```text block after one must be in what
that block printed. Numbers with a point may differ a little, everything else may not. Of the first block the line that
builds is left out, since the build is there, and the other one installs BUILD_FOLDER."""
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.M | re.S)
BUILD_LINE = "bash .ci/setup.sh installed\n"
MARK = "@@ block "


def same_word(wanted, got):
    number = r"-?\d+\.\d+"
    if re.fullmatch(number, wanted) and re.fullmatch(number, got):
        return abs(float(wanted) - float(got)) <= 0.02 * abs(float(wanted)) + 0.02
    return wanted == got


def same_line(wanted, got):
    a, b = wanted.split(), got.split()
    return len(a) == len(b) and all(map(same_word, a, b))


def contains(lines, wanted):
    """Whether `wanted` lines stand together in `lines`."""
    return any(
        all(map(same_line, wanted, lines[i : i + len(wanted)])) for i in range(len(lines) - len(wanted) + 1)
    )


def main():
    build = os.path.abspath(sys.argv[1])
    with open(os.path.join(ROOT, "docs", "tutorial.md"), encoding="utf-8") as file:
        blocks = FENCE.findall(file.read())
    script, expected = "set -euo pipefail\n", []
    for language, text in blocks:
        if language == "sh":
            if not expected:
                if not text.startswith(BUILD_LINE) or text.count("build/release") != 1:
                    sys.exit("the first block no longer builds and installs: " + text)
                text = text.replace(BUILD_LINE, "").replace("build/release", '"%s"' % build)
            script += 'echo "%s%d"\n%s' % (MARK, len(expected), text)
            expected.append([])
        elif language == "text":
            expected[-1].append(text)
        else:
            sys.exit("a block of the tutorial is neither sh nor text: " + language)
    if len(expected) < 3:
        sys.exit("blocks are missing")
    with tempfile.TemporaryDirectory() as home:
        environment = dict(os.environ, HOME=home, LC_ALL="C.UTF-8")
        run = subprocess.run(
            ["bash", "-c", script], cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )
    output = run.stdout.decode(errors="replace")
    if run.returncode != 0:
        sys.exit(output + "\nthe tutorial ended with %d" % run.returncode)
    printed = re.split(MARK + r"\d+\n", output)[1:]
    for got, wanted in zip(printed, expected):
        for text in wanted:
            if not contains(got.splitlines(), text.splitlines()):
                sys.exit("the tutorial says\n%s\nbut what came is\n%s" % (text, got))
    print("tutorial: %d blocks run, %d outputs as told" % (len(expected), sum(map(len, expected))))


main()
