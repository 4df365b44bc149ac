#!/usr/bin/env python3
"""Runs the ```python blocks of a document, each in a namespace of its own, in a folder with what they read:
run_document.py DOCUMENT MODELS [STEP_FILE]. Without a STEP file the blocks that read assembly.step are left out."""
import os
import re
import shutil
import sys
import tempfile

os.environ["MPLBACKEND"] = "Agg"  # no window
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.M | re.S)


def main():
    document, models = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    step = os.path.abspath(sys.argv[3]) if len(sys.argv) > 3 else None
    with open(document, encoding="utf-8") as file:
        text = file.read()
    ran = 0
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(models, os.path.join(folder, "models"))
        if step:
            shutil.copy(step, os.path.join(folder, "assembly.step"))
        os.chdir(folder)
        for match in BLOCK.finditer(text):
            if "assembly.step" in match[1] and not step:
                print("left out, for want of a STEP file:\n" + match[1])
                continue
            lines = text.count("\n", 0, match.start(1))
            exec(compile("\n" * lines + match[1], document, "exec"), {"__name__": "__main__"})
            ran += 1
    if ran == 0:
        sys.exit("no code was run")
    print("%d blocks" % ran)


main()
