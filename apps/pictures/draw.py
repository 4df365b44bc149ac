#!/usr/bin/env python3
"""Draws the pictures of docs/concepts.md from runs of the library: draw.py DOC_PICTURES OUT [--check].

DOC_PICTURES is the program made of runs.cpp; the pictures (SVG) go to OUT. With --check nothing is written: they are
compared with those in OUT, texts exactly and numbers to half a pixel. Python's standard library only."""
import csv
import math
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
INK, FAINT, BLUE, ORANGE, GREEN, RED = "#222222", "#bbbbbb", "#1f5fa8", "#d97a00", "#2c8a4b", "#c62828"
STEEL, SAND = "#dfe4ea", "#f6dcb5"


class Picture:
    def __init__(self, width, height):
        self.size = width, height
        self.parts = ['<rect width="%d" height="%d" fill="#ffffff"/>' % self.size]

    def add(self, tag, text=None, **attributes):
        items = "".join(' %s="%s"' % (k.replace("_", "-"), number(v)) for k, v in attributes.items())
        self.parts.append("<%s%s/>" % (tag, items) if text is None else "<%s%s>%s</%s>" % (tag, items, text, tag))

    def text(self, x, y, text, color=INK, anchor="start"):
        text = text.replace("&", "&amp;").replace("<", "&lt;")
        self.add("text", text, x=x, y=y, fill=color, text_anchor=anchor)

    def line(self, points, color, width=1.6, dash=None, fill="none", closed=False):
        extra = {"stroke_dasharray": dash} if dash else {}
        where = " ".join("%s,%s" % (number(x), number(y)) for x, y in points)
        self.add("polygon" if closed else "polyline", points=where, fill=fill, stroke=color, stroke_width=width, **extra)

    def arrow(self, x, y, dx, dy, color):
        n = math.hypot(dx, dy)
        ux, uy = dx / n, dy / n
        tip, base = (x + dx, y + dy), (x + dx - 8 * ux, y + dy - 8 * uy)
        self.line([(x, y), base], color, 2)
        self.line([tip, (base[0] - 4 * uy, base[1] + 4 * ux), (base[0] + 4 * uy, base[1] - 4 * ux)], color, 1, None, color, True)

    def svg(self):
        head = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" font-family="sans-serif" font-size="13">'
        return "\n".join([head % self.size] + self.parts + ["</svg>\n"])


def number(value):
    return value if isinstance(value, str) else ("%.1f" % value).replace("-0.0", "0.0")


class Axes:
    """A plot in a rectangle of a picture."""

    def __init__(self, picture, box, x, y, x_ticks, y_ticks, y_label, x_label=None, log=False):
        self.p, self.box, self.x, self.y, self.log = picture, box, x, y, log
        left, top, width, height = box
        for t in y_ticks:
            _, at = self.place(x[0], t)
            picture.line([(left, at), (left + width, at)], "#e8e8e8", 1)
            picture.text(left - 6, at + 4, "%g" % t, INK, "end")
        for t in x_ticks:
            at, _ = self.place(t, y[0])
            picture.line([(at, top + height), (at, top + height + 4)], INK, 1)
            if x_label:
                picture.text(at, top + height + 18, "%g" % t, INK, "middle")
        picture.line([(left, top), (left, top + height), (left + width, top + height)], INK, 1)
        picture.text(left, top - 8, y_label)
        if x_label:
            picture.text(left + width, top + height + 34, x_label, INK, "end")

    def place(self, x, y):
        left, top, width, height = self.box
        low, high = self.y
        part = math.log(y / low) / math.log(high / low) if self.log else (y - low) / (high - low)
        return left + width * (x - self.x[0]) / (self.x[1] - self.x[0]), top + height * (1 - part)

    def plot(self, xs, ys, color, width=1.8, dash=None, every=1):
        """`ys` that are None, and those above a plot of logarithms, end a line."""
        run = []
        for x, y in list(zip(xs, ys))[::every] + [(None, None)]:
            if y is not None and y <= self.y[1]:
                run.append(self.place(x, y))
            elif run:
                self.p.line(run, color, width, dash)
                run = []


def table(folder, name):
    with open(os.path.join(folder, name + ".csv"), newline="") as file:
        return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]


def column(rows, key, scale=1.0):
    return [scale * row[key] for row in rows]


def section(path, pose=None):
    """Where the plane y = 0 cuts a mesh (mm): pieces of lines in x and z, moved by a pose that turns about y."""
    vertices, pieces = [], []
    for line in open(path):
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["f"]:
            corners = [vertices[int(w.split("/")[0]) - 1] for w in words[1:4]]
            # a hair beside the plane, which vertices lie on
            sides = [(c[0], c[1] - 1e-4, c[2]) for c in corners]
            cut = []
            for a, b in zip(sides, sides[1:] + sides[:1]):
                if (a[1] < 0) != (b[1] < 0):
                    s = a[1] / (a[1] - b[1])
                    cut.append((a[0] + s * (b[0] - a[0]), a[2] + s * (b[2] - a[2])))
            if len(cut) == 2:
                pieces.append([moved(point, pose) for point in cut] if pose else cut)
    return pieces


def moved(point, pose):
    """`point` (x, z in mm) of a body at `pose` (m, turned about y)."""
    x, z = point
    angle = 2 * math.atan2(pose["qy"], pose["qw"])
    c, s = math.cos(angle), math.sin(angle)
    return 1e3 * pose["x"] + c * x + s * z, 1e3 * pose["z"] - s * x + c * z


def draw_coupling(data):
    rows = table(data, "coupling")
    t, p = column(rows, "t"), Picture(720, 420)
    height = Axes(p, (60, 30, 480, 210), (0, 1.3), (13, 26), [0.5, 1], [15, 20, 25], "height of the cube's center, mm")
    height.plot([0, 1.3], [20, 20], FAINT, 6)
    height.plot(t, column(rows, "pen", 1e3), ORANGE, 1.8, "5 3", 10)
    height.plot(t, column(rows, "part", 1e3), BLUE, 2.4, None, 10)
    p.text(552, height.place(0, 20.2)[1], "part X: stays on the floor", BLUE)
    p.text(552, height.place(0, 17.6)[1], "pen Y: goes on", ORANGE)
    force = Axes(p, (60, 280, 480, 90), (0, 1.3), (0, 2), [0.5, 1], [0, 1, 2], "force on the hand, N, up", "time, s")
    force.plot(t, column(rows, "force"), GREEN, 1.8, None, 5)
    p.text(552, force.place(0, 1.2)[1], "k (X \u2212 Y) + d (X\u0307 \u2212 Y\u0307)", GREEN)
    return p


def draw_gap(data):
    rows = [r for r in table(data, "coupling") if 0.15 < r["t"] < 1.15]
    t, p = column(rows, "t"), Picture(720, 260)
    a = Axes(p, (60, 30, 480, 170), (0.15, 1.15), (4, 2000), [0.2, 0.4, 0.6, 0.8, 1], [10, 100, 1000], "gap, \u00b5m", "time, s", True)
    a.plot([0.15, 1.15], [20, 20], FAINT, 1.6, "6 4")
    p.text(552, a.place(0, 20)[1], "l_min: a contact below")
    a.plot(t, [g if g < 2000 else None for g in column(rows, "gap", 1e6)], BLUE, 2, None, 5)
    p.text(552, a.place(0, 9)[1], "kept: half of it", BLUE)
    p.text(552, a.place(0, 200)[1], "nearer: a limit, so that no")
    p.text(552, a.place(0, 200)[1] + 17, "motion makes it negative")
    return p


def draw_contacts(data):
    p = Picture(720, 460)
    x_pose, y_pose = table(data, "contacts_poses")
    seen = set()

    def place(point):
        return 250 + 10 * point[0], 130 + 10 * point[1] * -1

    hole = section(os.path.join(ROOT, "models", "hole_20.obj"))
    peg = os.path.join(ROOT, "models", "peg_0.94.obj")
    rim, wall = 11.013266, 10.01206  # of the model, mm
    for sign in (-1, 1):
        block = [(sign * 22, 0), (sign * rim, 0), (sign * wall, -1), (sign * wall, -30), (sign * 22, -30)]
        p.line([place(q) for q in block], STEEL, 1, None, STEEL, True)
    for piece in hole:
        if all(abs(x) < 22 for x, _ in piece) and max(z for _, z in piece) > -30:
            p.line([place((x, max(z, -30))) for x, z in piece], INK, 1.4)
    for pose, color, dash in ((y_pose, ORANGE, "5 3"), (x_pose, BLUE, None)):
        for piece in section(peg, pose):
            p.line([place(q) for q in piece], color, 1.8, dash)
    for row in table(data, "contacts"):
        at = place((1e3 * row["x"], 1e3 * row["z"]))
        key = round(at[0]), round(at[1])
        if key in seen or abs(row["y"]) > 5e-4:
            continue
        seen.add(key)
        p.arrow(at[0], at[1], 46 * row["nx"], -46 * row["nz"], RED)
        p.add("circle", cx=at[0], cy=at[1], r="4", fill=RED)
        p.text(at[0] + (14 if row["nx"] < 0 else -14), at[1] + (18 if row["nx"] < 0 else 5),
               "gap %.0f \u00b5m" % (1e6 * row["gap"]), RED, "start" if row["nx"] < 0 else "end")
    p.text(500, 60, "pen Y", ORANGE)
    p.text(500, 82, "part X, jammed", BLUE)
    p.text(500, 104, "contacts: point and normal,", RED)
    p.text(500, 121, "from the hole to the peg", RED)
    return p


def draw_way(data):
    p, rows = Picture(720, 400), table(data, "way")

    def place(point):
        return 300 + 9 * point[0], 180 - 9 * point[1]

    square = [(-4, -4), (4, -4), (4, 4), (-4, 4)]
    p.line([place(q) for q in ((-28, -0.1), (28, -0.1), (28, 0.1), (-28, 0.1))], INK, 1, None, INK, True)
    for row in rows:
        p.line([place(moved(q, row)) for q in square], "#a9c6e6", 0.7, None, "none", True)
    last = {}
    for row in rows:
        last[row["tick"]] = row
    for tick, row in last.items():
        if tick > 7:
            continue
        pen = place((1e3 * row["pen_x"], 1e3 * row["pen_z"]))
        p.add("circle", cx=pen[0], cy=pen[1], r="4", fill=ORANGE)
        p.text(pen[0] + 8, pen[1] + 4, "%d" % tick, ORANGE)
        p.line([place(moved(q, row)) for q in square], BLUE, 2.2, None, "none", True)
    p.text(505, 40, "pen, tick 0 to 7", ORANGE)
    p.text(505, 60, "part after each tick", BLUE)
    p.text(505, 80, "pieces on the way", "#6f9dcf")
    p.text(55, 200, "sheet, 0.2 mm")
    return p


def draw_safety(data):
    rows, p = table(data, "safety"), Picture(720, 300)
    t = column(rows, "t")
    a = Axes(p, (60, 30, 630, 210), (0, 2), (0, 4.2), [0.5, 1, 1.5, 2], [0, 1, 2, 3, 4], "force on the hand, N, up", "time, s")
    silent = [a.place(x, y) for x, y in ((0.6, 0), (0.7, 0), (0.7, 4.2), (0.6, 4.2))]
    p.line(silent, "#f3d9d9", 1, None, "#f3d9d9", True)
    a.plot(t, column(rows, "wanted"), FAINT, 1.8, "5 3", 5)
    a.plot(t, column(rows, "force"), GREEN, 2.2, None, 2)
    for i, words in enumerate(("the application is silent", "for 0.1 s: after 20 ms the", "force fades within 3 ms")):
        p.text(a.place(0.58, 0)[0], a.place(0, 3.8)[1] + 17 * i, words, INK, "end")
    p.text(a.place(0.75, 0)[0], a.place(0, 0.5)[1], "off until the hand")
    p.text(a.place(0.75, 0)[0], a.place(0, 0.5)[1] + 17, "lets go")
    p.text(a.place(1.4, 0)[0], a.place(0, 1.9)[1], "then it comes back")
    p.text(a.place(1.1, 0)[0], a.place(0, 3.2)[1], "what the spring wants", "#888888")
    return p


def draw_rates(data):
    rows, p = table(data, "rates"), Picture(720, 300)
    a = Axes(p, (60, 30, 470, 210), (0.2, 0.4), (-0.5, 1.4), [0.2, 0.25, 0.3, 0.35, 0.4], [-0.5, 0, 0.5, 1], "force on the hand, N, up", "time, s")
    labels = ((2, RED, 1.2, None, "contact loop at 100 Hz alone"), (0, FAINT, 4, None, "contact loop at 1 kHz"),
              (1, BLUE, 1.6, None, "at 100 Hz, with planes"))
    for i, (case, color, width, dash, label) in enumerate(labels):
        own = [r for r in rows if r["case"] == case and 0.2 <= r["t"] <= 0.4]
        a.plot(column(own, "t"), column(own, "force"), color, width, dash)
        p.text(540, 60 + 22 * i, label, "#888888" if color == FAINT else color)
    return p


def draw_deadline(_):
    """Of the table kept beside the pictures: time on the clock does not repeat."""
    rows, p = table(os.path.join(ROOT, "docs", "pictures"), "deadline"), Picture(720, 300)
    a = Axes(p, (60, 30, 430, 210), (0, 0.45), (0, 15), [0, 0.1, 0.2, 0.3, 0.4], [0, 5, 10, 15],
             "how far the part is from the pen, mm", "time, s")
    stop = a.place(0.3, 0)[0]
    p.line([(stop, 30), (stop, 240)], FAINT, 1, "3 3")
    p.text(stop + 5, 44, "the pen stops", "#888888")
    for i, (budget, color) in enumerate(((5e-5, RED), (1e-4, ORANGE), (8e-4, BLUE))):
        own = [r for r in rows if r["budget"] == budget]
        a.plot(column(own, "t"), column(own, "lag", 1e3), color, 1.8)
        cut = sum(column(own, "cut"))
        p.text(505, 70 + 22 * i, "%g ms: %d of %d ticks cut" % (1e3 * budget, cut, len(own)), color)
    return p


PICTURES = {"coupling": draw_coupling, "gap": draw_gap, "contacts": draw_contacts, "way": draw_way,
            "safety": draw_safety, "rates": draw_rates, "deadline": draw_deadline}
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def differ(new, old):
    """What is different: the texts around the numbers, or a number by more than half a pixel."""
    if NUMBER.sub("#", new) != NUMBER.sub("#", old):
        return "other lines or words"
    for a, b in zip(NUMBER.findall(new), NUMBER.findall(old)):
        if abs(float(a) - float(b)) > 0.5:
            return "%s instead of %s" % (a, b)
    return None


def main():
    program, out, check = sys.argv[1], sys.argv[2], sys.argv[3:] == ["--check"]
    bad = []
    with tempfile.TemporaryDirectory() as data:
        subprocess.run([program, os.path.join(ROOT, "models"), data], check=True)
        for name, draw in PICTURES.items():
            path, svg = os.path.join(out, name + ".svg"), draw(data).svg()
            if check:
                with open(path, encoding="utf-8") as file:
                    what = differ(svg, file.read())
                if what:
                    bad.append("%s: %s" % (path, what))
            else:
                with open(path, "w", encoding="utf-8") as file:
                    file.write(svg)
    if bad:
        sys.exit("\n".join(bad + ["the pictures are out of date: cmake --build build/release --target pictures"]))
    print("%d pictures" % len(PICTURES))


if __name__ == "__main__":
    main()
