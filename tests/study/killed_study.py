#!/usr/bin/env python3
"""A study whose workers are killed at random has the bytes of the undisturbed one:
killed_study.py TEGOTAE shards|hosts|hypershell|clients --cases N --kills K [--seed S].

shards: two workers of the shard contract, each begun again when it is killed; two workers may even have the same shard.
hosts: GNU parallel over three hosts, which are network namespaces of this machine where it allows them. A host dies with
all that it runs. hypershell: `tegotae study run`, which is interrupted once and whose workers are killed. clients:
HyperShell's clients, as on four hosts, are killed in the middle of a task, and passes made until nothing is missing."""
import argparse
import csv
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

import drivers

KILL = signal.SIGKILL

# Stands in for ssh: `ssh HOST COMMAND`. Its commands run in a session that the test can kill, as when the host dies,
# and have nothing of this machine's network where that can be had.
HOST = """#!/bin/bash
while [ "${1#-}" != "$1" ]; do
  case $1 in -o|-p|-l) shift 2 ;; *) shift ;; esac
done
name=$1
shift
[ "$1" = -- ] && shift
echo $$ >> "%(folder)s/hosts/$name"
exec %(isolate)s setsid --wait bash -c 'echo $$ >> "'"%(folder)s/hosts/$name"'"; '"$*"
"""


def undisturbed(tegotae, folder, cases):
    study = drivers.write_study(folder, cases)
    begin = time.time()
    drivers.run([tegotae, "study", study, "--out", folder + "/once", "--jobs", "2"])
    took = time.time() - begin
    drivers.run([tegotae, "study", "merge", study, "--out", folder + "/once"])
    table = drivers.read(folder, "once", "cases.csv")
    if table.count(b"\n") != cases + 2:
        sys.exit("the undisturbed table has %d lines" % table.count(b"\n"))
    ends = [row["reached"] for row in csv.DictReader(table.decode().splitlines()[1:])]
    print("undisturbed: %d of %d cases reached the goal" % (ends.count("1"), cases), flush=True)
    if set(ends) != {"0", "1"}:
        sys.exit("the cases end all alike; give them another time or goal")
    return study, table, took


def processes():
    """Of the machine: number, parent, command."""
    found = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open("/proc/%s/stat" % pid, encoding="utf-8", errors="replace") as file:
                parent = file.read().rsplit(")", 1)[1].split()[1]
            with open("/proc/%s/cmdline" % pid, encoding="utf-8", errors="replace") as file:
                found.append((int(pid), int(parent), file.read().replace("\0", " ")))
        except OSError:
            pass  # it has ended
    return found


def children(of):
    """Processes below the process `of`: number and command."""
    rows, below = processes(), {of}
    while True:
        more = {pid for pid, parent, _ in rows if parent in below} - below
        if not more:
            return [(pid, command) for pid, _, command in rows if pid in below and pid != of]
        below |= more


def session(pid):
    """Its number; 0 for a process that has ended."""
    try:
        return os.getsid(pid)
    except ProcessLookupError:
        return 0


def kill(pids):
    """Whether one of them was there."""
    hit = False
    for pid in pids:
        try:
            os.kill(pid, KILL)
            hit = True
        except ProcessLookupError:
            pass
    return hit


def run_shards(o, folder, study, chance):
    """Two workers at a time, both killed now and then."""
    shards = ["%d/7" % i for i in range(1, 8)] + ["3/7"]  # one of them twice
    todo, running, kills = list(reversed(shards)), [], 0
    while todo or running:
        while todo and len(running) < 2:
            shard = todo.pop()
            command = [o.tegotae, "study", study, "--out", folder + "/out", "--jobs", "1", "--shard", shard]
            running.append((shard, subprocess.Popen(command, stdout=subprocess.DEVNULL)))
        time.sleep(o.wait * 2 * chance.random())
        alive = [one[1] for one in running if one[1].poll() is None]
        if kills < o.kills and alive:
            victim = chance.choice(alive)
            victim.kill()
            kills += victim.wait() == -KILL
        for one in list(running):
            code = one[1].poll()
            if code is None:
                continue
            running.remove(one)
            if code == -KILL:
                todo.append(one[0])
            elif code != 0:
                sys.exit("shard %s ended with %d" % (one[0], code))
    return kills


def watch(process, o, most, victims, chance, what):
    """Kills one of victims() now and then, at most so many, until the process has ended."""
    kills, end = 0, time.time() + o.patience
    while process.poll() is None:
        if time.time() > end:
            kill([process.pid])
            sys.exit(what + " does not end")
        if kills == most:
            time.sleep(0.05)
            continue
        time.sleep(o.wait * 2 * chance.random())
        while process.poll() is None and time.time() < end:
            found = victims()
            if found and kill(chance.choice(found)):
                kills += 1
                break
            time.sleep(0.02)
    if process.returncode != 0:
        sys.exit("%s ended with %d\n%s" % (what, process.returncode, process.stdout.read()))
    return kills


def interrupt(o, command):
    """Ctrl-C while shards are worked on: nothing goes on, and the exit code is 1."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=drivers.environment())
    found, end = [], time.time() + o.patience
    while not found and process.poll() is None and time.time() < end:
        time.sleep(0.05)
        found = [pid for pid, args in children(process.pid) if "--shard" in args]
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=o.patience)[0]
    if process.returncode != 1 or "interrupted; the same command continues" not in said:
        sys.exit("Ctrl-C at %d workers: ended with %d: %s" % (len(found), process.returncode, said))
    left = [args for pid, _, args in processes() if pid in found]  # a zombie has no arguments
    if any(left):
        sys.exit("after Ctrl-C goes on: " + "; ".join(left))


def run_hypershell(o, folder, study, chance):
    if not drivers.program("hs"):
        drivers.skip("no HyperShell (pip install hypershell)")
    command = [o.tegotae, "study", "run", study, "--out", folder + "/out", "--processors", "2", "--shards", "24"]
    interrupt(o, command)
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=drivers.environment(), start_new_session=True)
    workers = lambda: [[pid] for pid, args in children(process.pid) if args.startswith(o.tegotae) and "--shard" in args]
    return watch(process, o, o.kills, workers, chance, "tegotae study run")


def serve(o, folder, tasks, kills, chance):
    """One pass of HyperShell's server over the tasks, as docs/study.md has it, with a client on each of four hosts: how
    many of them were killed, of at most so many and never the last one."""
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = free.getsockname()[1]
    # `hs cluster` waits ten minutes for a client that says nothing, a server by itself as long as it is told.
    env = dict(drivers.environment(), HYPERSHELL_SERVER_QUEUESIZE="4", HYPERSHELL_SERVER_EVICT="20", HYPERSHELL_CLIENT_HEARTRATE="1")
    common = ["-p", str(port), "-k", "the-key-of-this-test"]
    hs = drivers.program("hs")
    process = subprocess.Popen([hs, "server", tasks, "--no-db"] + common, env=env, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, start_new_session=True)
    clients = [subprocess.Popen([hs, "client", "-d", "5", "-T", "30"] + common, env=env, stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL) for _ in range(4)]

    def at_work():
        """Each client that works on a shard now, with what it runs, where it is not the last one."""
        alive = [client.pid for client in clients if client.poll() is None]
        below = [[pid] + [child for child, _ in children(pid)] for pid in alive]
        busy = [pids for pids in below if len(pids) > 1]
        return busy if len(alive) > 1 else []

    try:
        return watch(process, o, kills, at_work, chance, "hs server")
    finally:
        kill([client.pid for client in clients if client.poll() is None])
        kill([pid for pid, _, _ in processes() if session(pid) == process.pid])


def run_clients(o, folder, study, chance):
    """What a dead client took with it is of the next pass: a pass without a kill leaves nothing."""
    if not drivers.program("hs"):
        drivers.skip("no HyperShell (pip install hypershell)")
    tasks = folder + "/tasks"
    with open(tasks, "w", encoding="utf-8") as file:
        file.writelines("%s study %s --out %s/out --jobs 1 --shard %d/24\n" % (o.tegotae, study, folder, i) for i in range(1, 25))
    merge, kills, passes = [o.tegotae, "study", "merge", study, "--out", folder + "/out", "--replays", "0"], 0, 0
    while subprocess.run(merge, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode != 0:
        begin, killed = time.time(), serve(o, folder, tasks, o.kills - kills, chance)
        kills, passes = kills + killed, passes + 1
        print("pass %d: %d clients killed, %.0f s" % (passes, killed, time.time() - begin), flush=True)
        if killed == 0 and subprocess.run(merge, stdout=subprocess.DEVNULL).returncode != 0:
            sys.exit("a pass without a kill left cases")
    return kills


def isolated():
    """The command that gives a host a network of its own; empty where that is not allowed."""
    can = shutil.which("unshare") and subprocess.run(["unshare", "-n", "true"], stderr=subprocess.DEVNULL).returncode == 0
    return "unshare -n" if can else ""


def run_hosts(o, folder, study, chance):
    if not drivers.program("parallel"):
        drivers.skip("no GNU parallel (apt-get install parallel)")
    names = ["one", "two", "three"]
    os.mkdir(folder + "/hosts")
    isolate = isolated()
    print("hosts: " + ("namespaces with a network of their own" if isolate else "NOT isolated: this machine allows no namespaces"), flush=True)
    ssh = folder + "/ssh"
    with open(ssh, "w", encoding="utf-8") as file:
        file.write(HOST % {"folder": folder, "isolate": isolate})
    os.chmod(ssh, 0o755)
    hosts = ",".join("1/" + name for name in names)
    command = ["parallel", "--will-cite", "--ssh", ssh, "-S", hosts, "--retries", "100",
               "%s study %s --out %s/out --jobs 1 --shard {}/24" % (o.tegotae, study, folder), ":::"]
    process = subprocess.Popen(command + [str(i) for i in range(1, 25)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True, env=dict(drivers.environment(), HOME=folder), start_new_session=True)

    def alive():
        """All processes of each host that works on a shard now: those of its session."""
        numbers = set()
        for name in os.listdir(folder + "/hosts"):
            with open(os.path.join(folder, "hosts", name), encoding="utf-8") as file:
                numbers |= {int(line) for line in file.read().split()}
        sessions, at_work = {}, set()
        for pid, _, command in processes():
            number = session(pid)
            if number in numbers:
                sessions.setdefault(number, []).append(pid)
                if command.startswith(o.tegotae):
                    at_work.add(number)
        return [sessions[session] for session in sorted(at_work)]

    return watch(process, o, o.kills, alive, chance, "parallel")


def main():
    parse = argparse.ArgumentParser()
    parse.add_argument("tegotae")
    parse.add_argument("how", choices=["shards", "hosts", "hypershell", "clients"])
    parse.add_argument("--cases", type=int, required=True)
    parse.add_argument("--kills", type=int, required=True)
    parse.add_argument("--seed", type=int, default=1)
    o = parse.parse_args()
    o.patience = 600 + o.cases  # s; less than that of the tests, so that what was started is ended
    chance = random.Random(o.seed)
    ways = {"shards": run_shards, "hosts": run_hosts, "hypershell": run_hypershell, "clients": run_clients}
    with tempfile.TemporaryDirectory(prefix="tegotae_study_") as folder:
        study, table, took = undisturbed(o.tegotae, folder, o.cases)
        o.wait = 0.5 * took / max(1, o.kills)  # whatever the machine, the kills fall within the study
        begin = time.time()
        kills = ways[o.how](o, folder, study, chance)
        took = time.time() - begin
        drivers.run([o.tegotae, "study", "merge", study, "--out", folder + "/out"])
        if drivers.read(folder, "out", "cases.csv") != table:
            sys.exit("the table is another one than that of the undisturbed study")
        if drivers.read(folder, "out", "report.html") != drivers.read(folder, "once", "report.html"):
            sys.exit("the report is another one")
        left = [name for name in os.listdir(folder + "/out/shards") if not name.endswith(".csv")]
        print("%s: %d cases, %d kills, the same table after %.1f s; left over: %d" % (o.how, o.cases, kills, took, len(left)))
        if kills != o.kills:
            sys.exit("only %d of %d kills hit anything" % (kills, o.kills))


main()
