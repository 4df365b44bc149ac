#!/usr/bin/env python3
"""Measures the table of docs/tuning.md: tuning.py TEGOTAE PAGE [--check].

A cube is pressed on a floor with couplings of rising stiffness, held by two grips, in virtual time. The table between the
page's comment lines is written anew; with --check it is compared instead, numbers to 5 % and 0.02."""
import csv
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BEGIN, END = "<!-- begin tuning.py -->\n", "<!-- end tuning.py -->\n"
STIFFNESS = (200, 800, 2600, 6400, 12800, 32000, 64000)  # N/m
GRIPS = (  # in words, as the scene file has it, script's depth that gives about 1.5 N, m
    ("relaxed", "{ stiffness = 400, damping = 24, mass = 0.3 }", 0.015),
    ("loose", "{ stiffness = 100, damping = 2, mass = 0.02 }", 0.005),
)
SCENE = """unit = "mm"
[[part]]
name = "floor"
mesh = "{models}/floor.obj"
[[part]]
name = "cube"
mesh = "{models}/cube.obj"
held = true
position = [0, 0, 0.022]
[coupling]
stiffness = {stiffness}
[device]
script = "press.csv"
hand = {hand}
"""
SCRIPT = "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.022,1,0,0,0\n0.4,0,0,{z},1,0,0,0\n2,0,0,{z},1,0,0,0\n"


def press(program, stiffness, hand, z):
    """Mean force, N, and swing of the force, N, from highest to lowest, of a second under a hand that has come to rest."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "s.toml"), "w") as file:
            file.write(SCENE.format(models=os.path.join(ROOT, "models"), stiffness=stiffness, hand=hand))
        with open(os.path.join(folder, "press.csv"), "w") as file:
            file.write(SCRIPT.format(z=z))
        recording = os.path.join(folder, "r.csv")
        run = [program, "run", os.path.join(folder, "s.toml"), "--fast", "--record", recording]
        if subprocess.run(run, stdout=subprocess.DEVNULL).returncode > 1:  # 1: did not get to the script's end, below the floor
            sys.exit("failed: " + " ".join(run))
        with open(recording, newline="") as file:
            force = [float(row["fz"]) for row in csv.DictReader(file) if 1 < float(row["t"]) < 2]
    return sum(force) / len(force), max(force) - min(force)


def table(program):
    lines = ["| stiffness, N/m | " + " | ".join("%s grip: force, N | swing, N" % name for name, _, _ in GRIPS) + " |",
             "|---" * (1 + 2 * len(GRIPS)) + "|"]
    for stiffness in STIFFNESS:
        cells = ["%.2f | %.2f" % press(program, stiffness, hand, z) for _, hand, z in GRIPS]
        lines.append("| %d | %s |" % (stiffness, " | ".join(cells)))
    return "".join(line + "\n" for line in lines)


def same(new, old):
    number = re.compile(r"\d+(?:\.\d+)?")
    if number.sub("#", new) != number.sub("#", old):
        return False
    pairs = zip(map(float, number.findall(new)), map(float, number.findall(old)))
    return all(abs(a - b) <= 0.05 * abs(b) + 0.02 for a, b in pairs)


def main():
    program, page, check = sys.argv[1], sys.argv[2], sys.argv[3:] == ["--check"]
    with open(page, encoding="utf-8") as file:
        before, old, after = re.split("%s|%s" % (re.escape(BEGIN), re.escape(END)), file.read())
    new = table(program)
    if check and not same(new, old):
        sys.exit("%s has\n%sbut it is\n%s" % (page, old, new))
    if not check:
        with open(page, "w", encoding="utf-8") as file:
            file.write(before + BEGIN + new + END + after)


main()
