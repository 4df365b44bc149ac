#!/usr/bin/env python3
"""How many cases a second, on how many processors, and what the drivers cost: throughput.py TEGOTAE [--markdown FILE]
[--cases N] [--repeats R]. Figures are medians of R runs. With --markdown it replaces the generated part of a file. What a
driver costs is in processor time, which other work on the machine hardly changes; it changes the cases a second, so the
table tells the load."""
import argparse
import os
import resource
import shlex
import statistics
import sys
import tempfile
import time

import drivers

BEGIN, END = "<!-- begin generated -->\n", "<!-- end generated -->\n"


def commands(tegotae, study, out, processors, shards):
    """The drivers, and how each is told."""
    shard = "%s study %s --out %s --jobs 1 --shard {}/%d" % (tegotae, study, out, shards)
    ways = {"one process": [tegotae, "study", study, "--out", out, "--jobs", str(processors)]}
    if drivers.program("parallel"):
        ways["GNU parallel"] = ["sh", "-c", "seq %d | parallel --will-cite -j %d %s" % (shards, processors, shlex.quote(shard))]
    if drivers.program("hs"):
        ways["HyperShell"] = [tegotae, "study", "run", study, "--out", out, "--processors", str(processors), "--shards",
                              str(shards)]
    return ways


def processor_time():
    """Of all processes that were waited for, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def measure(tegotae, folder, way, cases, processors, per_shard):
    """Seconds that it takes, and of processors."""
    where = tempfile.mkdtemp(dir=folder)
    study = drivers.write_study(where, cases, seconds=1)
    command = commands(tegotae, study, where + "/out", processors, max(1, cases // per_shard))[way]
    begin, before = time.monotonic(), processor_time()
    drivers.run(command, cwd=where)
    return time.monotonic() - begin, processor_time() - before


def median(tegotae, folder, way, cases, processors, per_shard, repeats):
    """Of each of the two figures by itself."""
    return [statistics.median(figure)
            for figure in zip(*(measure(tegotae, folder, way, cases, processors, per_shard) for _ in range(repeats)))]


def line(tegotae, folder, way, cases, processors, per_shard, repeats, alone):
    """A row: the time of a quarter of the cases tells what a case takes and what the start does."""
    few, many = (median(tegotae, folder, way, n, processors, per_shard, repeats) for n in (cases // 4, cases))
    each, work = ((many[i] - few[i]) / (cases - cases // 4) for i in (0, 1))
    start = max(0.0, few[0] - each * (cases // 4))
    if way == "one process":
        alone[processors] = work
        return "| %d | %s | – | %.1f | %.1f | – |" % (processors, way, start, 1 / each)
    cost = 1e3 * (work - alone[processors])
    return "| %d | %s | %d | %.1f | %.1f | %.1f |" % (processors, way, per_shard, start, 1 / each, cost)


def main():
    parse = argparse.ArgumentParser()
    parse.add_argument("tegotae")
    parse.add_argument("--markdown")
    parse.add_argument("--cases", type=int, default=160, help="of rows with a case a shard; ten times as many of others")
    parse.add_argument("--repeats", type=int, default=3)
    o = parse.parse_args()
    tegotae = os.path.abspath(o.tegotae)
    steps, n = [], 1
    while n <= (os.cpu_count() or 1):
        steps.append(n)
        n *= 2
    rows = ["Command: `python3 tests/study/throughput.py build/release/bin/tegotae --cases %d --repeats %d --markdown docs/study.md`"
            % (o.cases, o.repeats),
            "", "| processors | driver | cases a shard | start and end, s | cases a second | driver's cost, ms a case |",
            "|---|---|---|---|---|---|"]
    alone, load = {}, [os.getloadavg()[0]]
    with tempfile.TemporaryDirectory(prefix="tegotae_throughput_") as folder:
        for processors in steps:
            for way in commands(tegotae, "", "", 1, 1):
                for per_shard in (20,) if way == "one process" else (1, 20):
                    # HyperShell ends in steps of seconds, which are longer than a few large shards take.
                    cases = o.cases * (1 if per_shard == 1 else 10)
                    rows.append(line(tegotae, folder, way, cases, processors, per_shard, o.repeats, alone))
                    print(rows[-1], flush=True)
                    load.append(os.getloadavg()[0])
    rows[1] = "%d processors; medians of %d runs; load of the machine before it began %.1f, while it ran %.1f to %.1f.\n" % (
        os.cpu_count() or 1, o.repeats, load[0], min(load[1:]), max(load[1:]))
    if not o.markdown:
        return
    with open(o.markdown, encoding="utf-8") as file:
        page = file.read()
    if BEGIN not in page or END not in page:
        sys.exit(o.markdown + ": has no generated part")
    page = page[: page.index(BEGIN) + len(BEGIN)] + "\n".join(rows) + "\n" + page[page.index(END):]
    with open(o.markdown, "w", encoding="utf-8") as file:
        file.write(page)


main()
