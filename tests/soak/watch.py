#!/usr/bin/env python3
"""Watches a live page's stream: watch.py URL. Ends with 0 when the stream ends, and with a message when what comes is
not what docs and apps/view/wire.hpp say, or when no frame comes for half a minute."""
import http.client
import socket
import struct
import sys
import time
import urllib.parse

PATIENCE = 30  # s; a device that is killed is back in a few


def messages(url):
    """Kind and body of one message after the other: 32 bits of kind, 32 bits of length, the body."""
    address = urllib.parse.urlsplit(url)
    token = urllib.parse.parse_qs(address.query)["token"][0]
    connection = http.client.HTTPConnection(address.netloc, timeout=PATIENCE)
    connection.request("GET", "/stream", headers={"X-Tegotae-Token": token})
    answer = connection.getresponse()
    if answer.status != 200:
        sys.exit(f"watch: {answer.status} {answer.reason}")
    while len(head := answer.read(8)) == 8:
        kind, length = struct.unpack("<II", head)
        body = answer.read(length)
        if len(body) < length:
            return  # the application was killed
        yield kind, body


def main():
    newest, came = -1, time.monotonic()
    for kind, body in messages(sys.argv[1]):
        if kind not in (1, 2):
            sys.exit(f"watch: message of kind {kind}")
        if kind == 1:  # a frame begins with the tick in two floats
            high, low = struct.unpack_from("<2f", body)
            tick = int(high) * (1 << 20) + int(low)
            if tick <= newest:
                sys.exit(f"watch: tick {tick} after {newest}")
            newest, came = tick, time.monotonic()
        elif time.monotonic() - came > PATIENCE:
            sys.exit(f"watch: no frame for {PATIENCE} s after tick {newest}")


try:
    main()
except (ConnectionError, http.client.HTTPException):
    pass  # the application was killed
except socket.timeout:
    sys.exit(f"watch: nothing came for {PATIENCE} s")
