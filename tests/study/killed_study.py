#!/usr/bin/env python3
"""A study whose workers are killed at random has the bytes of the undisturbed one:
killed_study.py TEGOTAE shards|hosts|hypershell --cases N --kills K [--seed S].

shards: two workers of the shard contract, each begun again when it is killed; two workers may even have the same shard.
hosts: GNU parallel over three hosts, which are network namespaces of this machine where it allows them. A host dies with
all that it runs. hypershell: `tegotae study run`, whose workers are killed."""
import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import drivers

KILL = signal.SIGKILL
PATIENCE = 1500  # s

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
        if kills < o.kills:
            if kill([chance.choice(running)[1].pid]):
                kills += 1
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


def watch(process, o, victims, chance, what):
    """Kills one of victims() now and then until the process has ended."""
    kills, end = 0, time.time() + PATIENCE
    while process.poll() is None:
        if time.time() > end:
            kill([process.pid])
            sys.exit(what + " does not end")
        time.sleep(o.wait * 2 * chance.random())
        found = victims()
        if kills < o.kills and found and kill(chance.choice(found)):
            kills += 1
    if process.returncode != 0:
        sys.exit("%s ended with %d\n%s" % (what, process.returncode, process.stdout.read()))
    return kills


def run_hypershell(o, folder, study, chance):
    if not drivers.program("hs"):
        drivers.skip("no HyperShell (pip install hypershell)")
    command = [o.tegotae, "study", "run", study, "--out", folder + "/out", "--processors", "2", "--shards", "24"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=drivers.environment(), start_new_session=True)
    workers = lambda: [[pid] for pid, args in children(process.pid) if args.startswith(o.tegotae) and "--shard" in args]
    return watch(process, o, workers, chance, "tegotae study run")


def isolated():
    """The command that gives a host a network of its own; empty where that is not allowed."""
    can = shutil.which("unshare") and subprocess.run(["unshare", "-n", "true"], stderr=subprocess.DEVNULL).returncode == 0
    return "unshare -n" if can else ""


def run_hosts(o, folder, study, chance):
    if not drivers.program("parallel"):
        drivers.skip("no GNU parallel (apt-get install parallel)")
    names = ["one", "two", "three"]
    os.mkdir(folder + "/hosts")
    ssh = folder + "/ssh"
    with open(ssh, "w", encoding="utf-8") as file:
        file.write(HOST % {"folder": folder, "isolate": isolated()})
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
            try:
                session = os.getsid(pid)
            except ProcessLookupError:
                continue
            if session in numbers:
                sessions.setdefault(session, []).append(pid)
                if command.startswith(o.tegotae):
                    at_work.add(session)
        return [sessions[session] for session in sorted(at_work)]

    return watch(process, o, alive, chance, "parallel")


def main():
    parse = argparse.ArgumentParser()
    parse.add_argument("tegotae")
    parse.add_argument("how", choices=["shards", "hosts", "hypershell"])
    parse.add_argument("--cases", type=int, required=True)
    parse.add_argument("--kills", type=int, required=True)
    parse.add_argument("--seed", type=int, default=1)
    o = parse.parse_args()
    chance = random.Random(o.seed)
    ways = {"shards": run_shards, "hosts": run_hosts, "hypershell": run_hypershell}
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
        if kills < max(1, o.kills // 2):
            sys.exit("only %d of %d kills hit anything" % (kills, o.kills))


main()
