#!/usr/bin/env python3
"""Does what docs/study.md says: run_study_doc.py TEGOTAE. Its ```toml block is the study of the first ```sh block; each
other ```sh block has a cheap study of that name. `ssh`, `sbatch` and `srun` are stand-ins that run here what they are
given. A block whose program is absent is left out, and named. All folders of results end with the same table."""
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
value() { sed -n "s/^#SBATCH --$1=//p" "$script"; }
last=$(value array)
if [ -z "$last" ]; then
  SLURM_NNODES=$(value nodes) SLURM_CPUS_PER_TASK=$(value cpus-per-task) exec sh "$script"
fi
last=${last#1-}
for i in $(seq "$last"); do
  SLURM_ARRAY_TASK_ID=$i SLURM_ARRAY_TASK_COUNT=$last sh "$script" || exit
done
""",
    # One task on each node of the allocation; ends with the worst of their exit codes.
    "srun": """#!/bin/bash
for i in $(seq "$SLURM_NNODES"); do
  "$@" &
  all+=($!)
done
code=0
for one in "${all[@]}"; do wait "$one" || code=$?; done
exit $code
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
    tables, left_out, blocks_run = {}, [], set()
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
            for out in set(re.findall(r"--out (?:\$PWD/)?(\w+)", text)):
                tables[text, out] = drivers.read(folder, out, "cases.csv")
                blocks_run.add(text)
    if len(set(tables.values())) != 1:
        sys.exit("the drivers make different tables")
    print("%d blocks run; %d folders of results have the same table" % (1 + len(blocks_run), len(tables)))
    if left_out:
        drivers.skip("not there: " + ", ".join(sorted(set(left_out))))


main()
