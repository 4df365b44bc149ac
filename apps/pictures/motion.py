#!/usr/bin/env python3
"""Draws the moving picture of the README, an SVG that moves by itself: motion.py PEG_IN_HOLE OUT.svg [--check].

PEG_IN_HOLE is the program. Of a run of it the plane y = 0 is shown: the parts cut there, where the pen wants the peg, the
force on the pen, and what the hand feels over time. With --check nothing is written: OUT.svg must have the same lines, with
whatever numbers. Python's standard library only."""
import csv
import math
import os
import subprocess
import sys
import tempfile

from draw import BLUE, INK, NUMBER, RED, SAND, STEEL, Axes, Picture, number

FRAMES_PER_SECOND = 15
SCALE = 4.2  # pixels a millimeter
ORIGIN = 150, 225  # of the scene's frame in the picture
NEWTON = 70  # pixels


def read_obj(path):
    """Vertices (mm) and triangles of an OBJ file whose faces are triangles."""
    vertices, triangles = [], []
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if words[:1] == ["v"]:
                vertices.append(tuple(float(w) for w in words[1:4]))
            elif words[:1] == ["f"]:
                triangles.append([int(w.split("/")[0]) - 1 for w in words[1:4]])
    return vertices, triangles


def section(path, y=1e-4):
    """Closed lines (x, z) in which a closed mesh cuts the plane `y` (mm), which goes through no vertex."""
    vertices, triangles = read_obj(path)
    follow = {}
    for triangle in triangles:
        ends = {}
        for a, b in zip(triangle, triangle[1:] + triangle[:1]):
            (xa, ya, za), (xb, yb, zb) = vertices[a], vertices[b]
            if (ya < y) != (yb < y):
                s = (y - ya) / (yb - ya)
                ends[ya < y] = frozenset((a, b)), (xa + s * (xb - xa), za + s * (zb - za))
        if ends:
            follow[ends[True][0]] = ends[False]
    lines = []
    while follow:
        edge, line = next(iter(follow)), []
        while edge in follow:
            edge, point = follow.pop(edge)
            line.append(point)
        lines.append(line)
    return lines


def straight(line):
    """The line without points that repeat another or lie between two others in a row."""
    line = [p for i, p in enumerate(line) if math.dist(p, line[i - 1]) > 1e-3]
    out = []
    for i, (x, z) in enumerate(line):
        (px, pz), (nx, nz) = line[i - 1], line[(i + 1) % len(line)]
        if abs((x - px) * (nz - z) - (z - pz) * (nx - x)) > 1e-6:
            out.append((x, z))
    return out


def outline(lines):
    return " ".join("M" + "L".join("%.1f %.1f" % (SCALE * x, -SCALE * z) for x, z in straight(line)) + "Z" for line in lines)


def animate(attribute, values, seconds):
    return '<animate attributeName="%s" values="%s" dur="%.2fs" repeatCount="indefinite"/>' % (
        attribute, ";".join(values), seconds)


def turn_and_move(rows, prefix, seconds):
    """Animations of a pose in the plane y = 0."""
    moves = ["%.1f %.1f" % (ORIGIN[0] + 1e3 * SCALE * r[prefix + "px"], ORIGIN[1] - 1e3 * SCALE * r[prefix + "pz"])
             for r in rows]
    turns = ["%.2f" % math.degrees(2 * math.atan2(r[prefix + "qy"], r[prefix + "qw"])) for r in rows]
    text = '<animateTransform attributeName="transform" type="%s" values="%s" dur="%.2fs" repeatCount="indefinite"%s/>'
    return (text % ("translate", ";".join(moves), seconds, ""),
            text % ("rotate", ";".join(turns), seconds, ' additive="sum"'))


def moving(shape, rows, prefix, seconds):
    move, turn = turn_and_move(rows, prefix, seconds)
    return "<g>%s%s%s</g>" % (move, turn, shape)


def force_arrow(rows, seconds):
    """From the peg's own frame, where the pen is pushed to."""
    move, _ = turn_and_move(rows, "x_", seconds)
    xs = ["%.1f" % (NEWTON * r["fx"]) for r in rows]
    ys = ["%.1f" % (-NEWTON * r["fz"]) for r in rows]
    line = '<line x1="0" y1="0" stroke="%s" stroke-width="4" stroke-linecap="round">%s%s</line>' % (
        RED, animate("x2", xs, seconds), animate("y2", ys, seconds))
    return "<g>%s%s</g>" % (move, line)


def draw(scene, rows):
    seconds = rows[-1]["t"] - rows[0]["t"]
    p = Picture(700, 440)
    hole, peg = (outline(section(os.path.join(scene, name))) for name in ("hole_20.obj", "peg_0.94.obj"))
    at = '<g transform="translate(%d %d)">%%s</g>' % ORIGIN
    p.parts.append(at % ('<path d="%s" fill="%s" stroke="%s" fill-rule="evenodd"/>' % (hole, SAND, INK)))
    ghost = '<path d="%s" fill="none" stroke="%s" stroke-width="1.6" stroke-dasharray="5 4"/>' % (peg, BLUE)
    body = '<path d="%s" fill="%s" stroke="%s"/>' % (peg, STEEL, INK)
    p.parts += [moving(body, rows, "x_", seconds), moving(ghost, rows, "y_", seconds), force_arrow(rows, seconds)]
    p.text(320, 34, "X: the held part, which never enters the other", INK)
    p.text(320, 54, "Y: where the pen wants it", BLUE)
    p.text(320, 74, "what the pen pushes the hand with", RED)
    force = [math.hypot(r["fx"], r["fy"], r["fz"]) for r in rows]
    top = max(1, math.ceil(max(force)))
    box = (350, 150, 320, 220)
    a = Axes(p, box, (0, seconds), (0, top), range(0, int(seconds) + 1, 2), range(0, top + 1, max(1, top // 4)),
             "force on the pen, N", "s")
    a.plot([r["t"] - rows[0]["t"] for r in rows], force, RED, 1.4)
    xs = [number(a.place(r["t"] - rows[0]["t"], 0)[0]) for r in rows]
    p.parts.append('<line y1="%d" y2="%d" stroke="%s">%s%s</line>' % (
        box[1], box[1] + box[3], INK, animate("x1", xs, seconds), animate("x2", xs, seconds)))
    return p.svg()


def main():
    program, out = sys.argv[1], sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        record, scene = os.path.join(folder, "run.csv"), os.path.join(folder, "scene")
        command = [program, "--fast", "--ratio", "0.94", "--record", record, "--scene-out", scene, "--json"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        with open(record, newline="", encoding="utf-8") as file:
            every, rows = 0.0, []
            for r in csv.DictReader(file):
                if float(r["t"]) >= every:
                    rows.append({k: float(v) for k, v in r.items()})
                    every = rows[-1]["t"] + 1 / FRAMES_PER_SECOND - 1e-9
        svg = draw(scene, rows)
    if len(svg) > 1_000_000:
        sys.exit("%s: %d bytes, a README's picture has less than a million" % (out, len(svg)))
    if sys.argv[3:] == ["--check"]:
        with open(out, encoding="utf-8") as file:
            if NUMBER.sub("#", file.read()) != NUMBER.sub("#", svg):
                sys.exit(out + " is out of date: cmake --build build/release --target motion")
    else:
        with open(out, "w", encoding="utf-8") as file:
            file.write(svg)
    print("%s: %d frames, %.0f KB" % (out, len(rows), len(svg) / 1e3))


if __name__ == "__main__":
    main()
