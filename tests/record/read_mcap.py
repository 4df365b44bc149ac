"""Compares an MCAP recording, read by the reader of the MCAP project, with the CSV recording of the same run.

Usage: read_mcap.py RUN.mcap RUN.csv. Exits with 77 when Python's mcap package is not there.
"""
import csv
import json
import math
import sys

try:
    from mcap.reader import NonSeekingReader, SeekingReader
except ImportError:
    print("SKIPPED: Python's mcap package is not installed")
    sys.exit(77)

# docs/programs.md: the numbers of the CSV column `lag_reason`, by the words of the topic /tick.
LAG_REASONS = {"none": 0, "contact": 1, "time": 2, "capacity": 3, "suspended": 4}


def numbers(messages):
    """One frame's messages, by topic, as the columns of a CSV row."""
    tick, pen, part = messages["/tick"], messages["/pen"]["pose"], messages["/part"]["pose"]
    wrench, contact = messages["/wrench"], messages["/contact"]
    pose = lambda p: [p["position"][k] for k in "xyz"] + [p["orientation"][k] for k in "wxyz"]
    gap = math.inf if contact["gap"] is None else contact["gap"]
    return ([tick["tick"], tick["substep"], tick["t"]] + pose(pen) + pose(part)
            + [wrench[w][k] for w in ("force", "torque") for k in "xyz"] + [contact["contacts"], gap]
            + [tick["tick_us"], LAG_REASONS[tick["lag_reason"]]])


def frames(reader):
    by_number = {}
    for schema, channel, message in reader.iter_messages():
        assert schema.encoding == "jsonschema" and json.loads(schema.data)["type"] == "object"
        assert channel.message_encoding == "json"
        by_number.setdefault(message.sequence, {})[channel.topic] = json.loads(message.data)
    return [numbers(by_number[i]) for i in range(len(by_number))]


def main(mcap_path, csv_path):
    with open(csv_path) as file:
        rows = [[float(cell) for cell in row] for row in list(csv.reader(file))[1:]]
    assert len(rows) > 1000, len(rows)
    with open(mcap_path, "rb") as file:
        reader = SeekingReader(file, validate_crcs=True)
        summary = reader.get_summary()
        assert summary.statistics.message_count == 6 * len(rows)
        assert set(summary.statistics.channel_message_counts.values()) == {len(rows)}
        assert len(summary.chunk_indexes) == summary.statistics.chunk_count > 1
        assert sorted(c.topic for c in summary.channels.values()) == ["/contact", "/forces", "/part", "/pen", "/tick",
                                                                     "/wrench"]
        metadata = list(reader.iter_metadata())
        assert len(metadata) == 1 and metadata[0].metadata["scene"] and metadata[0].metadata["held"] == "peg"
        assert frames(reader) == rows
        # Through the indexes only a part is read: the middle fifth of a second.
        middle = round(1e9 * rows[len(rows) // 2][2])
        part = list(reader.iter_messages(topics="/part", starting_at=middle, ending_before=middle + 200_000_000))
        expected = [r for r in rows if middle <= round(1e9 * r[2]) < middle + 200_000_000]
        assert len(part) == len(expected) > 0, (len(part), len(expected))
    with open(mcap_path, "rb") as file:
        assert frames(NonSeekingReader(file, validate_crcs=True)) == rows
    print(f"{len(rows)} frames are the same")


main(*sys.argv[1:])
