"""The package as its users have it. Run by test_wheel.sh on an installed wheel."""

import gc
import os
import shutil
import subprocess
import sys
import threading
import time
import warnings

import numpy as np
import pytest

import tegotae

MODELS = os.environ["TEGOTAE_MODELS"]


def pose(x=0.0, y=0.0, z=0.0):
    X = np.eye(4)
    X[:3, 3] = x, y, z
    return X


def box(half):
    """A cube around the origin: 8 vertices, 12 triangles."""
    v = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return v, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def pegs():
    scene = tegotae.Scene()
    scene.add_fixed("hole", tegotae.load_mesh(MODELS + "/hole_20.obj", "mm"))
    scene.add_held("peg", tegotae.load_mesh(MODELS + "/peg_0.94.obj", "mm"), pose(z=0.03))
    return scene


def presses():
    """Down onto the rim, four millimeters off the axis."""
    return tegotae.ScriptPen([0, 0.5], [pose(0.004, z=0.03), pose(0.004, z=0.02)])


def test_views_are_no_copies_and_keep_the_mesh():
    v, t = box(0.01)
    mesh = tegotae.Mesh(v, t)
    first, second = mesh.vertices, mesh.vertices
    assert first.dtype == np.float64 and mesh.triangles.dtype == np.uint32
    assert np.shares_memory(first, second) and not first.flags.writeable and not first.flags.owndata
    with pytest.raises(ValueError):
        first[0, 0] = 1
    # Welding may change the order of vertices, not of triangles.
    np.testing.assert_array_equal(first[mesh.triangles], v[t])
    triangles, expected = mesh.triangles, v[t]
    del mesh, second
    gc.collect()
    junk = [np.full(len(v) * 3, 7.0) for _ in range(1000)]
    np.testing.assert_array_equal(first[triangles], expected)
    assert len(junk) == 1000


def test_center_of_mass_is_that_of_the_solid():
    v, t = box(0.01)
    mesh = tegotae.Mesh(v + [1, 2, 3], t)
    np.testing.assert_allclose(mesh.center_of_mass(), [1, 2, 3], atol=1e-9)
    assert mesh.report()["closed"] and mesh.report()["triangles"] == 12


@pytest.mark.parametrize(
    "vertices, triangles, text",
    [
        (box(1)[0], [[0, 1, 8]], "vertex 8 of 8"),
        (box(1)[0], [[0, 1, -1]], "vertex -1"),
        (box(1)[0], [[0.5, 1, 2]], "whole numbers"),
        (box(1)[0][:, :2], [[0, 1, 2]], "(8, 2), not (n, 3)"),
        ([[0, 0, 0], [1, 0, 0], [0, np.nan, 0]], [[0, 1, 2]], "row 2 is not finite"),
        ([[0, 0, 0], [2e6, 0, 0], [0, 1, 0]], [[0, 1, 2]], "row 1 is not finite, or beyond 1000 km"),
        (box(1)[0], np.empty((0, 3), int), "none"),
    ],
)
def test_meshes_that_cannot_be(vertices, triangles, text):
    with pytest.raises(tegotae.Error, match=text.replace("(", r"\(").replace(")", r"\)")) as e:
        tegotae.Mesh(vertices, triangles)
    assert e.value.kind == "setting"


def test_isolated_and_trusted_load_the_same():
    a = tegotae.load_mesh(MODELS + "/peg_0.94.obj")
    b = tegotae.load_mesh(MODELS + "/peg_0.94.obj", trusted=True)
    np.testing.assert_array_equal(a.vertices, b.vertices)
    np.testing.assert_array_equal(a.triangles, b.triangles)
    # 20 mm hole, ratio 0.94: the peg's radius is 9.4 mm.
    assert np.hypot(*a.vertices[:, :2].T).max() == pytest.approx(0.0094, abs=1e-6)


@pytest.mark.parametrize(
    "X, text",
    [
        (np.diag([2.0, 2, 2, 1]), "rotation"),
        (np.diag([-1.0, 1, 1, 1]), "mirror"),
        (np.diag([1.0, 1, 1, 2]), "last row"),
        (np.full((4, 4), np.nan), "finite"),
        (np.eye(3), "not \\((4|n, 4), 4\\)"),
        (pose(1e300), "beyond 10 km"),
        (pose(0, -10001), "beyond 10 km"),
    ],
)
def test_poses_that_cannot_be(X, text):
    scene, mesh = tegotae.Scene(), tegotae.Mesh(*box(1))
    with pytest.raises(tegotae.Error, match=text):
        scene.add_fixed("a", mesh, X)
    scene.add_held("a", mesh)
    with pytest.raises(tegotae.Error, match=text):
        scene.move("a", X)
    with pytest.raises(tegotae.Error, match=text):
        tegotae.ScriptPen([0.0], [X])
    with pytest.raises(tegotae.Error, match=text):
        tegotae.plan(scene, goal=X)
    assert (scene.pose("a") == np.eye(4)).all()


@pytest.mark.parametrize(
    "array, name",
    [
        (np.eye(4) + 1e-3j, "complex128"),
        (np.eye(4, dtype=np.complex64), "complex64"),
        (np.eye(4).astype(str), "str"),
        (np.zeros((4, 4), "datetime64[s]"), "datetime64"),
    ],
)
def test_what_are_no_real_numbers(array, name):
    scene, mesh = tegotae.Scene(), tegotae.Mesh(*box(1))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(TypeError, match="pose: real numbers are wanted, not %s" % name):
            scene.add_fixed("a", mesh, array)
        with pytest.raises(TypeError, match="poses: real"):
            tegotae.ScriptPen([0.0], [array])
        with pytest.raises(TypeError, match="vertices: real"):
            tegotae.Mesh(array[:3, :3], [[0, 1, 2]])
        with pytest.raises(TypeError, match="gravity: real"):
            scene.gravity = array[0, :3]
    # What can be made real numbers without a loss is taken.
    assert scene.add_fixed("b", mesh, np.eye(4, dtype=int)) == 0
    assert scene.add_fixed("c", mesh, np.eye(4, dtype=np.float16).tolist()) == 1


def test_errors_say_where(tmp_path):
    scene = tmp_path / "bad.toml"
    scene.write_text('unit = "mm"\n\n[contact]\nl_mni = 1e-5\n')
    with pytest.raises(tegotae.Error) as e:
        tegotae.load_scene(scene)
    assert e.value.kind == "file" and e.value.file == str(scene) and e.value.line == 4
    assert e.value.key == "contact.l_mni" and str(e.value).startswith("%s:4: contact.l_mni" % scene)
    with pytest.raises(tegotae.Error) as e:
        tegotae.load_mesh(tmp_path / "absent.stl")
    assert e.value.kind == "file" and e.value.file == str(tmp_path / "absent.stl")
    overlapping = pegs()
    overlapping.move("peg", pose(0.005, z=0.001))
    with pytest.raises(tegotae.Error) as e:
        tegotae.Rig(overlapping, presses())
    assert e.value.kind == "overlap" and "hole" in str(e.value)
    with pytest.raises(tegotae.Error, match="hole, peg") as e:
        overlapping.hold("pig")
    assert e.value.part == "pig"


def test_a_peg_goes_into_its_hole_and_no_pose_intersects(tmp_path):
    record = tmp_path / "peg.mcap"
    summary = tegotae.run(MODELS + "/peg_in_hole_0.94.toml", record=record)
    assert summary["completed"] and summary["depth_m"] > 0.02
    assert summary["penetrating"] == 0 and 100 < summary["checked"] <= summary["poses"]
    assert summary["lag"]["unexplained_ticks"] == 0
    assert summary["recordings"] == [str(record)]

    read = tegotae.read_recording(record)
    n = len(read)
    assert n >= summary["ticks"] and read.part.shape == (n, 4, 4) and read.wrench.shape == (n, 6)
    assert all(c.flags.c_contiguous and len(c) == n for c in (read.t, read.pen, read.tick, read.gap, read.lag_reason))
    R = read.part[:, :3, :3]
    np.testing.assert_allclose(R @ R.transpose(0, 2, 1), np.broadcast_to(np.eye(3), (n, 3, 3)), atol=1e-12)
    assert read.info["held"] == "peg" and read.damage == "" and np.all(np.diff(read.t) >= 0)
    assert np.linalg.norm(read.wrench[:, :3], axis=1).max() <= summary["force_max_n"] * (1 + 1e-9)
    assert len(read.forces) and read.forces["force"].min() >= 0 and read.forces["row"].max() < n
    np.testing.assert_allclose(np.linalg.norm(read.forces["normal"], axis=1), 1, atol=1e-9)
    # An independent reader: the CSV of the same run, by numpy.
    table = tmp_path / "peg.csv"
    tegotae.run(MODELS + "/peg_in_hole_0.94.toml", record=table)
    rows = np.genfromtxt(table, delimiter=",", names=True)
    np.testing.assert_array_equal(rows["t"], read.t)
    np.testing.assert_array_equal(rows["gap"], read.gap)


FORCES = ["depth", "insertion", "insertion_peak", "friction", "seating", "pull_out", "pull_out_peak"]


def columns(path):
    """What a program wrote, read by numpy: numbers alone."""
    return np.genfromtxt(path, delimiter=",", names=True)


def owned(array, shape, dtype="f8"):
    """One block, nobody else's, as it came from C++."""
    assert array.shape == shape and array.dtype == dtype and array.flags.c_contiguous and array.flags.writeable
    return array


def test_review_says_whether_it_goes(tmp_path):
    record = tmp_path / "peg.csv"
    tegotae.run(MODELS + "/peg_in_hole_0.94.toml", record=record, seconds=0.4)
    read = tegotae.read_recording(record)
    there = tegotae.review(record, goal=read.part[-1], report=tmp_path / "report.html")
    assert there.goes and there.verdict and there.evidence and (tmp_path / "report.html").exists()
    assert there.path.shape == (len(there.t), 4, 4) and np.all(np.diff(there.t) > 0)
    np.testing.assert_allclose(there.path[-1], read.part[-1], atol=1e-6)
    assert there.clearance.min() > 0 and {there.parts[k] for k in there.part if k >= 0} == {"hole"}
    assert there.outcome == "goes"
    # The script's end, 45 mm farther, is not where it was after 0.4 s, before that end.
    cut = tegotae.review(record)
    assert not cut.goes and cut.outcome == "open" and "before its script does" in cut.verdict
    assert cut.assembly_force is None  # CSV has no contacts


def test_a_review_has_the_numbers_of_the_program(tmp_path):
    record, csv, forces = (str(tmp_path / name) for name in ("peg.mcap", "path.csv", "forces.csv"))
    tegotae.run(MODELS + "/peg_in_hole_0.99.toml", record=record)
    before = sorted(os.listdir(tmp_path))
    file = tegotae.load_scene(MODELS + "/peg_in_hole_0.99.toml")
    made = tegotae.review(record, file)
    assert sorted(os.listdir(tmp_path)) == before
    program = ["tegotae", "review", record, "--out", str(tmp_path / "r.html"), "--csv", csv, "--forces", forces]
    assert subprocess.run(program, stdout=subprocess.DEVNULL).returncode == 0
    rows, n = columns(csv), len(made.t)
    for name, array in (("t", made.t), ("clearance", made.clearance), ("force", made.force), ("torque", made.torque)):
        np.testing.assert_array_equal(owned(array, (n,)), rows[name])
    owned(made.part, (n,), "i4")
    np.testing.assert_array_equal(owned(made.path, (n, 4, 4))[:, :3, 3], np.stack([rows["px"], rows["py"], rows["pz"]], 1))
    table, force = columns(forces), made.assembly_force
    assert list(force.dtype.names) == FORCES and all("`%s`" % name in tegotae.Review.__doc__ for name in FORCES)
    assert force.base is not None and len(force) == len(table) == 200
    np.testing.assert_allclose(force["depth"], 1e-3 * table["depth_mm"], rtol=1e-4)
    for name in FORCES[1:]:
        np.testing.assert_allclose(force[name], table[name + "_n"], rtol=1e-4, atol=1e-6)
    held = force["insertion"]
    del made, force
    gc.collect()
    junk = [np.full(200 * 9, 7.0) for _ in range(1000)]
    np.testing.assert_allclose(held, table["insertion_n"], rtol=1e-4, atol=1e-6)
    assert len(junk) == 1000


def test_plan_finds_the_way_in(tmp_path):
    scene, goal = MODELS + "/peg_in_hole_0.94.toml", pose(z=-0.01)
    way = tegotae.plan(scene, goal=goal, clearance=1e-4, to=tmp_path)
    assert way.found and way.summary["task"] == "goal" and (tmp_path / "script.csv").exists()
    assert way.path.shape == (len(way.t), 4, 4) and np.all(np.diff(way.t) > 0)
    np.testing.assert_allclose(way.path[-1], goal, atol=1e-6)
    # The peg's radius is 9.4 mm in a hole of 10: down there its axis is within the play, less what is to be left.
    deep = way.path[way.path[:, 2, 3] < -0.005]
    assert len(deep) and np.hypot(deep[:, 0, 3], deep[:, 1, 3]).max() <= 0.6e-3 - 1e-4
    assert way.clearance >= 1e-4 and way.distance.min() >= way.clearance - 1e-9
    # What was written is the same path.
    rows, n = columns(tmp_path / "path.csv"), len(way.t)
    np.testing.assert_array_equal(owned(way.t, (n,)), rows["t"])
    np.testing.assert_array_equal(owned(way.distance, (n,)), rows["clearance"])
    np.testing.assert_array_equal(owned(way.path, (n, 4, 4))[:, 2, 3], rows["pz"])
    assert {way.parts[k] for k in owned(way.part, (n,), "i4") if k >= 0} == {"hole"}
    # In memory it is the same too, and the scene is left as it was.
    memory = tegotae.load_scene(scene).scene
    before = memory.pose("peg")
    again = tegotae.plan(memory, goal=goal, clearance=1e-4)
    np.testing.assert_array_equal(again.path, way.path)
    np.testing.assert_array_equal(memory.pose("peg"), before)
    assert tegotae.plan(memory, hold="hole").summary["held"] == "hole" and memory.held == "peg"
    with pytest.raises(tegotae.Error, match="this scene has none"):
        tegotae.plan(memory, to=tmp_path)
    with pytest.raises(tegotae.Error, match="goal: the shape is"):
        tegotae.plan(memory, goal=np.eye(3))
    with pytest.raises(tegotae.Error):
        tegotae.plan(scene, goal=goal, clearance=1e-3)  # more than the play
    with pytest.raises(tegotae.Error, match="hole, peg"):
        tegotae.plan(scene, hold="pig")


def locked():
    """A cube in a closed box: it never comes out."""
    v, t = box(0.01)
    inner, outer = box(0.012)[0], box(0.02)[0]
    scene = tegotae.Scene()
    scene.add_fixed("box", tegotae.Mesh(np.concatenate([outer, inner]), np.concatenate([t, t[:, ::-1] + 8])))
    scene.add_held("cube", tegotae.Mesh(v, t))
    return scene


def test_ctrl_c_ends_a_plan_and_the_next_one_works(tmp_path):
    code = (
        "import sys, threading, time, tegotae\n"
        "sys.path.insert(0, %r)\n"
        "import test_package as here\n"
        "ticks = []\n"
        "threading.Thread(target=lambda: [(ticks.append(0), time.sleep(0.01)) for _ in range(50)], daemon=True).start()\n"
        "threading.Timer(1, lambda: __import__('_thread').interrupt_main()).start()\n"
        "began = time.monotonic()\n"
        "try:\n"
        "    tegotae.plan(here.locked(), seconds=1e5)\n"
        "except KeyboardInterrupt:\n"
        "    print('interrupted', len(ticks) > 10)\n"
        "print(tegotae.plan(here.locked(), iterations=5).found)\n"
    ) % os.path.dirname(os.path.abspath(__file__))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=240)
    assert done.stdout.split() == ["interrupted", "True", "False"], done.stderr


def test_plans_of_two_threads_are_those_of_one():
    goal, scene = pose(z=-0.01), MODELS + "/peg_in_hole_0.94.toml"
    alone = tegotae.plan(scene, goal=goal, seed=3).path
    made = []
    threads = [threading.Thread(target=lambda: made.append(tegotae.plan(scene, goal=goal, seed=3).path)) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(made) == 2
    for path in made:
        np.testing.assert_array_equal(path, alone)


def test_units_that_nobody_said_are_asked_for(tmp_path):
    v, t = box(20.0)
    obj = "".join("v %r %r %r\n" % tuple(map(float, p)) for p in v) + "".join("f %d %d %d\n" % tuple(f + 1) for f in t)
    (tmp_path / "cube.obj").write_text(obj)
    with pytest.raises(tegotae.Error, match="69.28 m across.*--unit mm"):
        tegotae.read_assembly(tmp_path / "cube.obj")
    part = tegotae.read_assembly(tmp_path / "cube.obj", unit="mm").parts[0]
    np.testing.assert_allclose(np.abs(part.mesh.vertices), 0.02, rtol=1e-6)


def test_contact_forces_sum_to_the_wrench():
    with tegotae.Rig(pegs(), presses()) as rig:
        rig.run(2.5)  # the hand rests: no damper
        contacts, F = rig.contacts, rig.wrench
        assert rig.force_off is None and len(contacts) and rig.report.lag_reason == "contact"
        held = contacts[contacts["force"] > 0]
        f = held["force"][:, None] * held["normal"] + held["friction"]
        arm = held["point_a"] - (rig.part[:3, :3] @ rig.center + rig.part[:3, 3])
        assert F[2] > 1
        assert np.linalg.norm(f.sum(0) - F[:3]) < 0.01 * np.linalg.norm(F[:3])
        assert np.linalg.norm(np.cross(arm, f).sum(0) - F[3:]) < 0.01 * np.linalg.norm(F[3:])
        np.testing.assert_allclose(rig.report.contact_wrench[:3], f.sum(0), atol=1e-9)
        assert set(contacts["part"]) == {0}
        # The hand's spring holds against it: 400 N/m from the pen to the script's end.
        assert rig.pen[2, 3] > 0.02


def test_simulated_time_repeats_bit_for_bit():
    def positions():
        ways = []
        with tegotae.Rig(pegs(), presses()) as rig:
            rig.run(0.6, lambda r: ways.append(np.concatenate([r.part.ravel(), r.wrench])))
        return np.array(ways)

    a, b = positions(), positions()
    assert len(a) == 600
    np.testing.assert_array_equal(a, b)


def test_events_begin_contacts():
    with tegotae.Rig(pegs(), presses()) as rig:
        known, began = set(), 0

        def look(r):
            nonlocal known, began
            for e in r.events:
                key = tuple(e[["part", "kind_a", "feature_a", "kind_b", "feature_b"]])
                (known.add if e["began"] else known.discard)(key)
                began += int(e["began"])
            now = {tuple(c[["part", "kind_a", "feature_a", "kind_b", "feature_b"]]) for c in r.contacts}
            assert known == now

        rig.run(0.6, look)
        assert began > 0 and known


def test_a_callback_that_raises_ends_the_run():
    with tegotae.Rig(pegs(), presses()) as rig:

        def stop(r):
            if r.steps == 10:
                raise KeyError("enough")

        with pytest.raises(KeyError, match="enough"):
            rig.run(1, stop)
        assert rig.steps == 10
        with pytest.raises(tegotae.Error, match="stepping"):
            rig.run(1, lambda r: r.step())
        assert rig.steps == 11
        rig.run(1, lambda r: r.request_stop())
        assert rig.steps == 12


def test_python_goes_on_beside_a_rig_in_real_time():
    """What one Python thread counts while rig.run() goes on, by what it counts while nothing else does."""
    over = threading.Event()
    counted, refused = [0], []

    def count():
        while not over.is_set():
            counted[0] += 1

    def look():
        try:
            rig.contacts
        except tegotae.Error as e:
            refused.append(str(e))
        finally:
            refused.append(rig.part)  # for any thread
            rig.request_stop()

    counter, other = threading.Thread(target=count, daemon=True), threading.Timer(0.2, look)
    with tegotae.Rig(pegs(), presses(), "real") as rig:
        counter.start()
        begin = counted[0]
        rig.run(1.0)
        beside = counted[0] - begin
        other.start()
        rig.run(60)
        other.join()
        over.set()
        counter.join()
        steps, servo = rig.steps, rig.servo
    # A thread that held the GIL would leave nothing to count; a switch of threads takes 5 ms.
    assert beside > 10_000
    assert steps > 100 and servo["ticks"] > 0
    assert "another thread" in refused[0] and refused[1].shape == (4, 4)


class Hand:
    """Goes down 1 mm every 50 reads, four millimeters off the axis, to 20 mm."""

    def __init__(self):
        self.reads, self.wrenches, self.threads = 0, [], set()

    def read(self):
        self.threads.add(threading.get_ident())
        self.reads += 1
        return pose(0.004, z=max(0.02, 0.03 - 0.001 * self.reads / 50))

    def write(self, wrench):
        self.wrenches.append(wrench)


def test_a_pen_in_python_in_simulated_time():
    hand = Hand()
    with tegotae.Rig(pegs(), tegotae.PythonPen(hand)) as rig:
        rig.run(0.8)
        assert 800 <= hand.reads <= 802
        # A stiff hand: it stands at 20 mm, the part on the rim, the spring between them.
        np.testing.assert_allclose(rig.pen, pose(0.004, z=0.02), atol=1e-9)
        np.testing.assert_allclose(hand.wrenches[-1], rig.wrench, atol=0.05)
        assert rig.wrench[2] > 1


def test_a_pen_in_python_in_real_time():
    hand = Hand()
    pen = tegotae.PythonPen(hand, rate=400)
    with tegotae.Rig(pegs(), pen, "real") as rig:
        rig.run(1.5)
        reads = hand.reads
        assert hand.threads and threading.get_ident() not in hand.threads
        assert 0 < pen.rate <= 420 and pen.samples >= reads
        # The servo goes on with the newest pose: it ticks oftener than Python answers.
        assert rig.servo["ticks"] > reads
    assert hand.wrenches
    again = hand.reads
    time.sleep(0.05)
    assert hand.reads == again


@pytest.mark.parametrize("clock", ["simulated", "real"])
def test_a_pen_in_python_that_raises(clock):
    class Broken(Hand):
        def read(self):
            if self.reads == 30:
                raise OSError("the cable is out")
            return super().read()

    rig = tegotae.Rig(pegs(), tegotae.PythonPen(Broken()), clock)
    rig.start()
    with pytest.raises(OSError, match="cable"):
        rig.run(10)
    rig.stop()

    class Wrong(Hand):
        def read(self):
            return np.eye(3)

    rig = tegotae.Rig(pegs(), tegotae.PythonPen(Wrong()), clock)
    with pytest.raises(tegotae.Error, match="read\\(\\) returned"):
        rig.start()


def test_the_scene_changes_while_it_runs():
    scene = pegs()
    with tegotae.Rig(scene, presses()) as rig:
        rig.run(0.6)
        assert len(rig.contacts)
        scene.remove("hole")
        change = rig.change(scene)
        assert change.state == "pending"
        rig.step(2)
        assert change.state == "in_force" and not len(rig.contacts)


def test_settings_are_kept():
    scene = pegs()
    scene.friction, scene.stiffness, scene.l_min, scene.gravity = 0.3, 500.0, 1e-5, [0, 0, -1]
    scene.set_friction("peg", "hole", 0.1)
    other = scene.copy()
    other.friction = 0.0
    assert (scene.friction, scene.stiffness, scene.l_min) == (0.3, 500.0, 1e-5) and scene.held == "peg"
    np.testing.assert_array_equal(scene.gravity, [0, 0, -1])
    with pytest.raises(tegotae.Error, match="qp"):
        scene.resolver = "qq"
    with pytest.raises(tegotae.Error, match="clock"):
        tegotae.Rig(scene, presses(), "wall")
    with pytest.raises(tegotae.Error, match="start"):
        tegotae.Rig(scene, presses()).run(1)


def test_an_interpreter_ends_beside_a_running_rig():
    """Nobody calls stop(): the interpreter must end all the same, with no word."""
    code = """
import sys, numpy as np, tegotae
sys.path.insert(0, %r)
import test_package as t
rig = tegotae.Rig(t.pegs(), tegotae.PythonPen(t.Hand()), "real")
rig.start()
rig.run(0.05)
""" % os.path.dirname(os.path.abspath(__file__))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_a_rig_that_only_a_cycle_holds_is_collected():
    class Owner(Hand):
        pass

    owner = Owner()
    owner.pen = tegotae.PythonPen(owner)
    owner.rig = tegotae.Rig(pegs(), owner.pen)
    owner.rig.start()
    owner.rig.stop()
    import weakref

    gone = weakref.ref(owner)
    del owner
    gc.collect()
    assert gone() is None


@pytest.mark.parametrize("call", ["rig.run(1000)", "rig.step(10**9)"])
def test_ctrl_c_ends_a_run(call):
    code = """
import sys, threading, time, signal, os, tegotae
sys.path.insert(0, %r)
import test_package as t
rig = tegotae.Rig(t.pegs(), t.presses(), "real")

def interrupt():
    try:
        while True:
            rig.steps  # refused while the main thread steps
            time.sleep(0.01)
    except tegotae.Error:
        os.kill(os.getpid(), signal.SIGINT)

with rig:
    threading.Thread(target=interrupt).start()
    try:
        %s
    except KeyboardInterrupt:
        print("interrupted")
""" % (os.path.dirname(os.path.abspath(__file__)), call)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, "interrupted", "")


@pytest.mark.parametrize("name", ["tegotae", "tegotae-device"])
def test_programs_are_on_the_path(name):
    path = shutil.which(name)
    assert path is not None
    said = subprocess.run([path, "--version"], capture_output=True, text=True, check=True).stdout
    assert tegotae.__version__ in said
    assert shutil.which("tegotae-load-mesh") is not None


def test_the_package_is_typed():
    folder = os.path.dirname(tegotae.__file__)
    assert os.path.exists(os.path.join(folder, "py.typed"))
    with open(os.path.join(folder, "_tegotae.pyi"), encoding="utf-8") as file:
        stub = file.read()
    compile(stub, "_tegotae.pyi", "exec")
    for name in ("class Rig", "def load_mesh", "def contacts(self) -> "):
        assert name in stub
    undocumented = [n for n in tegotae.__all__ if not n.startswith("__") and n != "contact_dtype" and not getattr(tegotae, n).__doc__]
    assert undocumented == []
