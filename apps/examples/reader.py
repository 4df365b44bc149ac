#!/usr/bin/env python3
"""Looks at a device's segment from Python, standard library only: reader.py NAME prints its pen as one line of JSON."""
import json
import mmap
import os
import struct
import sys

MAGIC, VERSION, SIZE = 0x314541544F474554, 6, 1600
DEVICE_COUNTER = 64  # offset of the counter; the slot of tegotae_shm_device follows it
DEVICE_WORDS = 47
# heartbeat_ns tick time_ns sequence, status ... force_freedom, name, position ... raw_orientation, scale
DEVICE = struct.Struct("=qQqQ 6I 32s 3d4d3d3d3d3d3d4d d")


def open_segment(name):
    """The segment as 64-bit words, after the checks that everyone makes before use."""
    with open("/dev/shm/" + name.lstrip("/"), "rb") as file:
        info = os.fstat(file.fileno())
        if info.st_uid != os.geteuid() or info.st_mode & 0o077 or info.st_size != SIZE:
            sys.exit(name + ": not mine alone, or not a segment of this protocol")
        memory = mmap.mmap(file.fileno(), SIZE, prot=mmap.PROT_READ)
    magic, version, size = struct.unpack_from("=QII", memory)
    if (magic, version, size) != (MAGIC, VERSION, SIZE):
        sys.exit(name + ": another protocol or version")
    return memoryview(memory).cast("Q")


def read_slot(words, counter, count):
    """One whole write, or None. On x86, where loads keep their order, comparing the counter is enough."""
    at = counter // 8
    for _ in range(64):
        before = words[at]
        if before == 0:
            return None
        if before % 2 == 0:
            copy = words[at + 1 : at + 1 + count].tobytes()
            if words[at] == before:
                return copy
    return None


def main():
    slot = read_slot(open_segment(sys.argv[1]), DEVICE_COUNTER, DEVICE_WORDS)
    if slot is None:
        sys.exit("no servo tick yet")
    f = DEVICE.unpack_from(slot)
    pen = {
        "heartbeat_ns": f[0],
        "tick": f[1],
        "status": f[4],
        "reason": f[5],
        "buttons": f[6],
        "name": f[10].split(b"\0")[0].decode(errors="replace"),
        "position": f[11:14],
        "orientation": f[14:18],
        "velocity": f[18:21],
        "force": f[24:27],
        "torque": f[27:30],
        "raw_position": f[30:33],
        "scale": f[37],
    }
    print(json.dumps(pen))


main()
