#!/usr/bin/env python3
"""Does what docs/study.md says: run_study_doc.py TEGOTAE. Its ```toml block is the study of the first ```sh block; each
other ```sh block has a cheap study of that name. `ssh` and `sbatch` are stand-ins that run here what they are given. A block
whose program is absent is left out, and named. All blocks end with the same table."""
import os
import re
import subprocess
import sys
import tempfile

import drivers

FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.M | re.S)
STANDS_IN = {
    "ssh": """#!/bin/bash
while [ "${1#-}" != "$1" ]; do
  case $1 in -o|-p|-l) shift 2 ;; *) shift ;; esac
done
shift
[ "$1" = -- ] && shift
exec bash -c "$*"
""",
    "sbatch": """#!/bin/bash
script=${!#}
last=$(sed -n 's/^#SBATCH --array=1-//p' "$script")
for i in $(seq "$last"); do
  SLURM_ARRAY_TASK_ID=$i SLURM_ARRAY_TASK_COUNT=$last sh "$script" || exit
done
""",
}


def run_block(text, folder, path):
    environment = dict(drivers.environment(), PATH=path, HOME=folder, PARALLEL="--will-cite",
                       HYPERSHELL_DATABASE_FILE=os.path.join(folder, "tasks.db"))
    done = subprocess.run(["bash", "-c", "set -euo pipefail\n" + text], cwd=folder, env=environment,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit("%s\nended with %d:\n%s" % (text, done.returncode, done.stdout))


def main():
    tegotae = os.path.abspath(sys.argv[1])
    with open(os.path.join(drivers.ROOT, "docs", "study.md"), encoding="utf-8") as file:
        blocks = FENCE.findall(file.read())
    toml = [text for language, text in blocks if language == "toml"]
    shell = [text for language, text in blocks if language == "sh"]
    if len(toml) != 1 or len(shell) < 5:
        sys.exit("blocks are missing")
    needs = {"study run ": "hs", "hs cluster": "hs", "parallel ": "parallel", "sbatch ": None}
    tables, left_out = {}, []
    with tempfile.TemporaryDirectory(prefix="tegotae_doc_") as top:
        os.mkdir(top + "/bin")
        for name, text in STANDS_IN.items():
            with open(top + "/bin/" + name, "w", encoding="utf-8") as file:
                file.write(text)
            os.chmod(top + "/bin/" + name, 0o755)
        path = os.pathsep.join([top + "/bin", os.path.dirname(tegotae), drivers.environment()["PATH"]])
        os.mkdir(top + "/peg")
        with open(top + "/peg/study.toml", "w", encoding="utf-8") as file:
            file.write(toml[0])
        run_block(shell[0], top + "/peg", path)
        for i, text in enumerate(shell[1:]):
            found = [need for mark, need in needs.items() if mark in text]
            if not found:
                sys.exit("this block is of no driver that the test knows:\n" + text)
            if found[0] and not drivers.program(found[0]):
                left_out.append(found[0])
                continue
            folder = "%s/%d" % (top, i)
            os.mkdir(folder)
            drivers.write_study(folder, 48)
            run_block(text, folder, path)
            out = re.findall(r"--out (?:\$PWD/)?(\w+)", text)[-1]
            tables[text] = drivers.read(folder, out, "cases.csv")
    if len(set(tables.values())) != 1:
        sys.exit("the drivers make different tables")
    print("%d blocks run, all with the same table" % (1 + len(tables)))
    if left_out:
        drivers.skip("not there: " + ", ".join(sorted(set(left_out))))


main()
