#!/usr/bin/env python3
"""Device, application and a watching page together: soak.py MINUTES [SEED]; docs/soak.md says what is judged.

Two thirds of the time processes are killed and stopped at random (the storm), one third they are left alone (the calm),
in which memory and missed servo ticks are judged. Exit code 0: all is well; 1: it is not; the table says what."""
import ctypes
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = ROOT / "build/release/bin"
WORK = ROOT / "build/soak"
NAME = f"tegotae-soak-{os.getpid()}"
SEGMENT = pathlib.Path("/dev/shm") / NAME

RECOVERY = 20  # s; until all goes on after a kill. A second suffices on an idle machine
ENDING = 180  # s; FCL is asked about up to 20 000 poses before a run ends
WARM = 20  # s of the calm before memory is compared
MOST_GROWTH = 2.0  # MB in the calm. The check of intersections keeps poses, 1.1 MB at most
MOST_MISSED = 0.05  # of the servo ticks of the calm: gross failure, whatever else the machine does

LIBC = ctypes.CDLL(None)


class Failure(Exception):
    pass


def die_with_parent():
    LIBC.prctl(1, signal.SIGKILL)


class Process:
    """A child with its output in files; ended by nobody but this program, or the run has failed."""

    def __init__(self, kind, number, command):
        self.kind, self.out, self.err = kind, WORK / f"{kind}.{number}.out", WORK / f"{kind}.{number}.err"
        with open(self.out, "wb") as out, open(self.err, "wb") as err:
            self.child = subprocess.Popen([str(c) for c in command], stdin=subprocess.DEVNULL, stdout=out, stderr=err,
                                          start_new_session=True, preexec_fn=die_with_parent,
                                          env={**os.environ, "TMPDIR": str(WORK / "tmp")})
        self.memory = None  # MB, descriptors, threads

    def alive(self):
        return self.child.poll() is None

    def measure(self):
        proc = pathlib.Path("/proc") / str(self.child.pid)
        fields = dict(line.split(":", 1) for line in (proc / "status").read_text().splitlines())
        return int(fields["VmRSS"].split()[0]) / 1024, len(os.listdir(proc / "fd")), int(fields["Threads"])

    def end(self, number):
        """Sends a signal and waits; the exit code."""
        self.child.send_signal(number)
        self.child.send_signal(signal.SIGCONT)
        try:
            return self.child.wait(ENDING)
        except subprocess.TimeoutExpired:
            raise Failure(f"{self.kind} does not end on {signal.Signals(number).name}")

    def forget(self):
        for file in (self.out, self.err):
            file.unlink(missing_ok=True)


def wait_for(what, condition):
    """Polls for at most RECOVERY s; what the condition gives."""
    end = time.monotonic() + RECOVERY
    while time.monotonic() < end:
        if value := condition():
            return value
        time.sleep(0.05)
    raise Failure(f"{what}: not within {RECOVERY} s")


def write_hand(dice, path, seconds):
    """A hand over and in the hole: down on its axis, or anywhere near it, tilted, and pressing on what is there."""
    t, rows = 0.0, ["t,px,py,pz,qw,qx,qy,qz", "0,0,0,0.045,1,0,0,0"]
    while t < seconds:
        t += dice.uniform(0.15, 1.2)
        off, tilt = (0.0, 0.0) if dice.random() < 0.5 else (0.006, 0.06)
        x, y, turn_x, turn_y = (dice.uniform(-s, s) for s in (off, off, tilt, tilt))
        rows.append(f"{t:.3f},{x:.6f},{y:.6f},{dice.uniform(-0.005, 0.045):.6f},1,{turn_x:.6f},{turn_y:.6f},0")
    path.write_text("\n".join(rows) + "\n")


class Soak:
    def __init__(self, minutes, seed):
        self.minutes, self.seed, self.dice = minutes, seed, random.Random(seed)
        self.processes, self.started, self.events = {}, 0, {}
        self.slowest = 0.0
        self.servo = {"ticks": 0, "missed": 0, "killed": 0, "off": 0}
        self.last_status = None
        self.rows = {"rows": 0, "touching": 0, "over": 0, "asked": 0, "intersecting": 0}
        self.force = self.torque = 0.0
        self.summaries = {"runs": 0, "penetrating": 0}
        self.calm = []
        self.problems = []

    # Processes
    def start(self, kind, command):
        self.started += 1
        self.processes[kind] = Process(kind, self.started, command)
        return self.processes[kind]

    def start_device(self):
        hand = WORK / "hand.csv"
        write_hand(self.dice, hand, 60 * self.minutes + 60)
        p = self.start("device", [BIN / "tegotae-device", "--type", "simulated", "--script", hand, "--name", NAME])
        wait_for("device: a first line", lambda: "\n" in p.out.read_text() or self.still(p))

    def start_application(self):
        scene = ROOT / "models" / f"peg_in_hole_{self.dice.choice(['0.94', '0.99'])}.toml"
        self.recording = WORK / "run.csv"
        p = self.start("application", [BIN / "tegotae", "run", scene, "--resolver", self.dice.choice(["qp", "lp"]),
                                       "--device", f"shm:{NAME}", "--view", "--json", "--record", self.recording])
        text = wait_for("application: its page", lambda: "\n" in (t := p.err.read_text()) and t or self.still(p))
        self.url = next(word for word in text.split() if word.startswith("http"))

    def start_page(self):
        self.start("page", [sys.executable, ROOT / "tests/soak/watch.py", self.url])

    def still(self, process):
        """None, or a failure when a process ended by itself."""
        if not process.alive():
            raise Failure(f"{process.kind} ended by itself with {process.child.returncode}: "
                          + process.err.read_text().strip()[-300:])

    def ensure(self):
        """Starts what is missing and waits until the application is with the device; notes how long it took."""
        begin = time.monotonic()
        for kind, start in (("device", self.start_device), ("application", self.start_application),
                            ("page", self.start_page)):
            if kind not in self.processes:
                start()
        wait_for("application with the device", self.together)
        self.slowest = max(self.slowest, time.monotonic() - begin)

    def together(self):
        status = self.status()
        return status and status["application"] and status["heartbeat_age_s"] is not None \
            and status["heartbeat_age_s"] < 0.5

    def status(self):
        for p in self.processes.values():
            self.still(p)
        done = subprocess.run([BIN / "tegotae-device", "--status", "--name", NAME, "--json"], capture_output=True,
                              text=True, timeout=RECOVERY)
        if done.returncode:
            return None
        self.last_status = json.loads(done.stdout)
        return self.last_status

    def gone(self, kind):
        """Takes a process that was ended off the list, and judges what it left."""
        p = self.processes.pop(kind)
        if kind == "device" and self.last_status:
            for key in ("ticks", "missed"):
                self.servo[key] += self.last_status[key]
            self.last_status = None
        if kind == "application":
            self.judge_recording()
            if "page" in self.processes:  # its stream is over
                self.wait_page()
        p.forget()

    def wait_page(self):
        page = self.processes.pop("page")
        try:
            if page.child.wait(RECOVERY):
                raise Failure(f"page: {page.err.read_text().strip()[-300:]}")
        except subprocess.TimeoutExpired:
            raise Failure("page: its stream does not end with the application")
        page.forget()

    # What happens to them
    def event(self, kind, what):
        self.events[what, kind] = self.events.get((what, kind), 0) + 1

    def kill(self, kind):
        self.status()
        self.event(kind, "killed")
        self.processes[kind].end(signal.SIGKILL)
        self.gone(kind)

    def finish(self, kind):
        """Asks a process to end, as Ctrl-C does."""
        self.status()
        self.event(kind, "ended")
        p = self.processes[kind]
        if code := p.end(signal.SIGINT):
            raise Failure(f"{kind} asked to end: exit code {code}: " + p.err.read_text().strip()[-300:])
        if kind == "application":
            summary = json.loads(p.out.read_text())
            self.summaries["runs"] += 1
            self.summaries["penetrating"] += summary["penetrating"]
        self.gone(kind)

    def stop(self, kind):
        self.event(kind, "stopped")
        p = self.processes[kind]
        p.child.send_signal(signal.SIGSTOP)
        time.sleep(self.dice.choice([0.01, 0.05, 0.3, 2.0]))
        p.child.send_signal(signal.SIGCONT)

    def storm(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            time.sleep(min(15.0, max(0.5, self.dice.expovariate(1 / 5))))
            act = self.dice.choices([self.kill, self.finish, self.stop], [4, 2, 4])[0]
            kind = self.dice.choices(["device", "application", "page"], [3, 3, 2])[0]
            act(kind if (act, kind) != (self.finish, "page") else "application")
            time.sleep(self.dice.choice([0, 0, 1.0]))  # some time without it
            self.ensure()

    def quiet(self, seconds):
        end, warm = time.monotonic() + seconds, time.monotonic() + min(WARM, seconds / 2)
        first = servo = None
        while time.monotonic() < end:
            time.sleep(1)
            status = self.status()
            if first is None and status and time.monotonic() >= warm:
                first, servo, begin = self.measure(), status, time.monotonic()
        last = self.status()
        for kind, after in self.measure().items():
            self.calm.append((kind, first[kind], after))
        self.calm_servo = last["ticks"] - servo["ticks"], last["missed"] - servo["missed"]
        self.calm_seconds = time.monotonic() - begin

    def measure(self):
        return {kind: p.measure() for kind, p in self.processes.items()}

    def judge_recording(self):
        if not self.recording.exists() or self.recording.stat().st_size < 10_000:
            return  # killed before it had moved
        done = subprocess.run([BIN / "soak_judge", self.recording], capture_output=True, text=True, timeout=600)
        if done.returncode:
            raise Failure(f"a recording cannot be read: {done.stderr.strip()}")
        found = json.loads(done.stdout)
        for key in self.rows:
            self.rows[key] += found[key]
        self.force, self.torque = max(self.force, found["force"]), max(self.torque, found["torque"])
        if found["over"] or found["intersecting"]:
            self.recording.rename(WORK / f"bad.{self.started}.csv")
            info = pathlib.Path(f"{self.recording}.info.json")
            info.rename(WORK / f"bad.{self.started}.csv.info.json")

    def run(self):
        self.ensure()
        self.slowest = 0.0  # the first start reads nothing from caches
        self.storm(40 * self.minutes)
        self.quiet(20 * self.minutes)
        self.finish("application")
        self.finish("device")

    def clean_up(self):
        for p in self.processes.values():
            if p.alive():
                p.child.kill()
                p.child.wait()

    # What came out
    def judge(self):
        left = [str(f) for f in [SEGMENT, *(WORK / "tmp").iterdir()] if f.exists()]
        ticks, missed = self.calm_servo
        bounds = [
            (self.rows["touching"] == 0, "the part never touched anything"),
            (self.rows["intersecting"] + self.summaries["penetrating"] > 0, "poses intersect"),
            (self.rows["over"] > 0, "wrenches above their limits"),
            (missed > MOST_MISSED * ticks, "the servo missed ticks in the calm"),
            (ticks == 0, "the servo stood still in the calm"),
            (bool(left), "left behind: " + ", ".join(left)),
        ]
        for kind, (before, files, threads), (after, files_after, threads_after) in self.calm:
            bounds.append((after - before > MOST_GROWTH, f"{kind} grew by {after - before:.1f} MB in the calm"))
            bounds.append((files_after > files, f"{kind} opened {files_after - files} files and kept them"))
            bounds.append((threads_after > threads, f"{kind} started {threads_after - threads} threads and kept them"))
        self.problems += [text for bad, text in bounds if bad]

    def table(self):
        def counted(what):
            return ", ".join(f"{kind} {n}" for (w, kind), n in sorted(self.events.items()) if w == what) or "none"

        ticks, missed = self.calm_servo
        rows = self.rows
        lines = [
            ("killed", counted("killed")),
            ("stopped a while", counted("stopped")),
            ("asked to end", counted("ended")),
            ("all again", f"{self.slowest:.1f} s after an event at most"),
            ("contact loop", f"{rows['rows']} poses recorded, {100 * rows['touching'] / max(1, rows['rows']):.0f} % in contact"),
            ("intersecting", f"{rows['intersecting']} of {rows['asked']} recorded poses asked of FCL; "
             f"{self.summaries['penetrating']} by {self.summaries['runs']} runs' own count"),
            ("wrench", f"at most {self.force:.3f} N, {1e3 * self.torque:.1f} mN m; {rows['over']} above the limits"),
            ("servo", f"{self.servo['missed']} of {self.servo['missed'] + self.servo['ticks']} ticks missed, while stopped for the most part"),
            ("  in the calm", f"{missed} of {missed + ticks}, {self.calm_seconds:.0f} s"),
        ]
        for kind, before, after in self.calm:
            lines.append((f"memory of {kind}", f"{before[0]:.2f} MB, after {self.calm_seconds:.0f} s of calm "
                          f"{after[0]:.2f} MB; {after[1]} files, {after[2]} threads"))
        for name, text in lines:
            print(f"  {name:22} {text}")


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: tests/soak.sh MINUTES [SEED]")
    soak = Soak(float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    shutil.rmtree(WORK, ignore_errors=True)
    (WORK / "tmp").mkdir(parents=True)
    try:
        print(f"soak: {soak.minutes:g} min, seed {soak.seed}", flush=True)
        soak.run()
        soak.judge()
        soak.table()
    except Failure as e:
        soak.problems.append(str(e))
    except KeyboardInterrupt:
        sys.exit(130)
    finally:
        soak.clean_up()
        SEGMENT.unlink(missing_ok=True)
    for text in soak.problems:
        print(f"soak: {text}")
    print("soak: " + ("FAILED" if soak.problems else "good"))
    sys.exit(1 if soak.problems else 0)


main()
