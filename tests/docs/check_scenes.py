#!/usr/bin/env python3
"""Every whole scene in the project's Markdown is one that can be run: check_scenes.py TEGOTAE. A ```toml block with parts
is written to a folder, beside models that stand in for the files that it names, and given to `tegotae check`. The test of
the test: with a key misspelled it must be refused."""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BLOCK = re.compile(r"^```toml\n(.*?)^```$", re.M | re.S)
STANDS_IN = {"hole.obj": "hole_20.obj", "peg.obj": "peg_0.94.obj", "insert.csv": "insert_0.94.csv"}


def check(program, scene):
    with tempfile.TemporaryDirectory() as folder:
        for name, model in STANDS_IN.items():
            shutil.copy(os.path.join(ROOT, "models", model), os.path.join(folder, name))
        path = os.path.join(folder, "scene.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(scene)
        return subprocess.run([program, "check", path], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def main():
    program, count = sys.argv[1], 0
    for page in [os.path.join(ROOT, "README.md")] + sorted(glob.glob(os.path.join(ROOT, "docs", "*.md"))):
        with open(page, encoding="utf-8") as file:
            scenes = [block for block in BLOCK.findall(file.read()) if "[[part]]" in block]
        for scene in scenes:
            count += 1
            result = check(program, scene)
            if result.returncode != 0:
                sys.exit("%s: %s\n%s" % (page, result.stdout, scene))
            if check(program, scene.replace("held", "hled")).returncode != 2:
                sys.exit("a misspelled key was taken")
    if count == 0:
        sys.exit("no scenes found")
    print("%d scenes" % count)


main()
