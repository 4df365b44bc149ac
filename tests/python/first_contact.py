"""What one does first with an installed wheel: feel a contact in Python, then on the page. first_contact.py MODELS_FOLDER"""

import csv
import re
import signal
import subprocess
import sys
import tempfile
import time
import urllib.request

import numpy as np

import tegotae

models = sys.argv[1]


def at(x, y, z):
    X = np.eye(4)
    X[:3, 3] = x, y, z
    return X


def in_python():
    scene = tegotae.Scene()
    scene.add_fixed("hole", tegotae.load_mesh(models + "/hole_20.obj", "mm"))
    scene.add_held("peg", tegotae.load_mesh(models + "/peg_0.94.obj", "mm"), at(0, 0, 0.03))
    pen = tegotae.ScriptPen([0, 0.5], [at(0.004, 0, 0.03), at(0.004, 0, 0.02)])
    with tegotae.Rig(scene, pen) as rig:
        rig.run(1.5)
        assert len(rig.contacts) > 0
        # Nothing moves any more: what the contacts push is what the hand feels.
        pushed = (rig.contacts["force"][:, None] * rig.contacts["normal"]).sum(axis=0)
        assert pushed[2] > 0.5 and np.allclose(pushed, rig.wrench[:3], rtol=0.02, atol=0.02), (pushed, rig.wrench)
        print("in Python: %d contacts, %.2f N" % (len(rig.contacts), np.linalg.norm(pushed)))


def on_the_page():
    with tempfile.TemporaryDirectory() as folder:
        record = folder + "/run.csv"
        # The scene's script takes its peg against the rim and down the hole, in real time.
        program = subprocess.Popen(
            ["tegotae", "run", models + "/peg_in_hole_0.94.toml", "--view", "--no-browser", "--record", record],
            stdout=subprocess.PIPE, text=True)
        try:
            url = next(found[0] for found in (re.search(r"http:\S+", line) for line in program.stdout) if found)
            with urllib.request.urlopen(url, timeout=20) as answer:
                page = answer.read().decode()
            assert answer.status == 200 and "<canvas" in page and "</html>" in page.lower()
            seconds = time.time()
            time.sleep(6)
        finally:
            program.send_signal(signal.SIGINT)
            program.stdout.read()
            program.wait(timeout=30)
        with open(record) as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        felt = [row for row in rows if int(row["contacts"]) > 0 and abs(float(row["fz"])) > 0.1]
        assert felt, "no contact in %d rows" % len(rows)
        print("on the page: %d bytes of it, %d rows with a felt contact" % (len(page), len(felt)))
        return seconds


in_python()
served = on_the_page()
print("first page at", served)
