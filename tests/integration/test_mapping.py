# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a mapping says, compared with what real nodes do."""

from __future__ import annotations

import csv
import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile import check
from rmw_manycore_py.platform.status import status
from support import IS_MANYCORE, wait_until
from support.peers.programs import forked_manycore

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore"),
]

PIPELINE = {"image_source": "image_raw", "image_filter": "image_inverted", "image_sink": None}
HEARD = r"image_sink +\| .*frame \d+ is "
MESSAGES = 8  # of an image source that publishes 10 times a second
QUIET = """\
import rclpy
from rclpy.qos import QoSProfile
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("node")
{endpoints}
rclpy.spin(node)
"""
NODES = {
    "first": (
        'a = node.create_publisher(String, "fixed", 50)\n'
        'b = node.create_publisher(String, "sent", QoSProfile(depth=3))\n'
        'c = node.create_publisher(String, "grows", 10)\n'
    ),
    "second": (
        'a = node.create_subscription(String, "fixed", print, 100)\n'
        'b = node.create_subscription(String, "sent", print, qos_profile=QoSProfile(depth=300))\n'
        'c = node.create_subscription(String, "grows", print, 10)\n'
    ),
}
PLATFORMS = {
    "granules of 1 KiB": "coolidge",
    "granules of a page": "{profile: host, clusters: 2, smem_size: 96MiB}",
}
ENDPOINTS = 2 * (2 + 7 * 2 + 3)


def answer(start, *words: str | Path) -> Any:
    program = start(forked_manycore(*words, "--json"))
    assert program.wait() == 0, program
    return json.loads(program.output[program.output.index(program.output.strip()[0]) :])


@pytest.mark.parametrize("kind", PLATFORMS)
def test_nodes_take_the_memory_that_is_predicted(start, tmp_path, platform, kind: str) -> None:
    text = (
        f"platform: {PLATFORMS[kind]}\ntopics:\n"
        "  /fixed: {type: std_msgs/msg/String, topic_dsm_size: 100000}\n"
        "  /sent: {type: std_msgs/msg/String, topic_dsm_size: 30000, transfer: async}\n"
        "nodes:\n"
    )
    for number, (name, endpoints) in enumerate(NODES.items(), start=1):
        (tmp_path / f"{name}.py").write_text(QUIET.format(endpoints=endpoints))
        text += f"  {name}: {{cluster: {number}, script: {name}.py}}\n"
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(text)
    predicted = {one.cluster: one.total for one in check(mapfile).memory if one.total}
    run = start(forked_manycore("run", mapfile))

    def are_all_there() -> bool:
        try:
            return len(status(platform).endpoints) == ENDPOINTS
        except ManycoreError:  # the platform is not there yet
            return False

    wait_until(are_all_there, "all endpoints exist")

    def used() -> dict[int, int]:
        return {one.id: one.used_bytes for one in status(platform).clusters}

    wait_until(lambda: used() == predicted, f"{predicted} bytes are used")
    assert run.stop() == 0


def write_pipeline(path: Path, *clusters: int) -> Path:
    lines = [
        f"  {name}: {{cluster: {cluster}, module: rmw_manycore_py.examples.{name}}}\n"
        for name, cluster in zip(PIPELINE, clusters, strict=True)
    ]
    path.write_text("platform: {profile: coolidge, smem_size: 64MiB}\nnodes:\n" + "".join(lines))
    return path


def traced(start, mapfile: Path, trace: Path) -> list[dict[str, str]]:
    """Run a mapfile, and return the events after all nodes had talked, as rows of the CSV file."""
    run = start(forked_manycore("run", mapfile))
    run.wait_for(HEARD)
    assert start(forked_manycore("trace", "start")).wait() == 0
    for _ in range(MESSAGES):
        run.skip_output()
        run.wait_for(HEARD)
    for words in (("stop",), ("save", "-o", trace)):
        assert start(forked_manycore("trace", *words)).wait() == 0
    assert run.stop() == 0
    lines = [line for line in trace.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def sends(events: list[dict[str, str]]) -> dict[tuple[str, int, int], set[str]]:
    """Return record numbers by topic, cluster of the publisher, and receiving cluster."""
    found: dict[tuple[str, int, int], set[str]] = {}
    for event in events:
        if event["kind"] == "send" and event["topic"] in ("/image_raw", "/image_inverted"):
            key = (event["topic"], int(event["cluster"]), int(event["value"]))
            found.setdefault(key, set()).add(event["number"])
    return found


def test_traces_are_counted_and_compared(start, tmp_path, platform) -> None:
    """One of clusters of their own, and one of all nodes together."""
    events: dict[str, list[dict[str, str]]] = {}
    for name, clusters in {"spread": (1, 2, 3), "together": (2, 2, 2)}.items():
        mapfile = write_pipeline(tmp_path / f"{name}.yaml", *clusters)
        events[name] = traced(start, mapfile, tmp_path / f"{name}.csv")
        assert len(sends(events[name])) == len(set(clusters)) - 1
    check_counts(start, tmp_path, events["spread"])
    check_comparison(start, tmp_path / "spread.csv", tmp_path / "together.csv")


def check_counts(start, tmp_path: Path, events: list[dict[str, str]]) -> None:
    """Look at the traced mapping, at the nodes together, and apart in another way.

    All counts are those of the raw events.
    """
    writes = [event for event in events if event["kind"] == "write"]
    messages = Counter(event["topic"] for event in writes)
    sizes: Counter[str] = Counter()
    for event in writes:
        sizes[event["topic"]] += int(event["value"])
    assert min(messages["/image_raw"], messages["/image_inverted"]) >= MESSAGES - 1
    placements = {
        (1, 2, 3): {("/image_raw", 1, 2), ("/image_inverted", 2, 3)},
        (4, 4, 4): set(),
        (5, 5, 1): {("/image_inverted", 5, 1)},
    }
    for clusters, expected in placements.items():
        mapfile = write_pipeline(tmp_path / "other.yaml", *clusters)
        data = answer(start, "map", "check", mapfile, "--trace", tmp_path / "spread.csv")["mapping"]
        seconds = data["trace"]["duration_s"]
        found = {
            (row["topic"], row["publisher_cluster"], row["receiver_cluster"]): (
                *(round(row[key] * seconds, 3) for key in ("messages_per_s", "bytes_per_s")),
            )
            for row in data["crossings"]
        }
        assert found == {key: (messages[key[0]], sizes[key[0]]) for key in expected}
        assert data["crossing_topics"] == len(expected)
        received = Counter[int]()
        for topic, _, cluster in expected:
            received[cluster] += messages[topic]
        threads = data["trace"]["receive_threads"]
        assert {row["cluster"]: round(row["messages_per_s"] * seconds, 3) for row in threads} == (
            received
        )
        peaks = data["trace"]["peak_smem_bytes"]
        assert set(peaks) == ({"1", "2", "3"} if clusters == (1, 2, 3) else set())
        cores = {row["cluster"]: row["cpu_share"] for row in data["trace"]["cores"]}
        assert set(cores) == set(clusters)
        assert all(0 < share < 1.5 * len(PIPELINE) for share in cores.values())
    # What is counted as crossing has been sent; the trace may begin or end within a publish.
    sent = sends(events)
    assert set(sent) == placements[1, 2, 3]
    for topic, *places in placements[1, 2, 3]:
        numbers = {event["number"] for event in writes if event["topic"] == topic}
        assert len(sent[topic, places[0], places[1]] ^ numbers) <= 2


def check_comparison(start, *files: Path) -> None:
    compare = start(forked_manycore("trace", "compare", *files))
    assert compare.wait() == 0
    heading, chain, mapping = compare.output.splitlines()
    assert heading.split() == ["before", "after", "verdict", "chain"]
    assert chain.endswith("/image_raw (/image_filter) > /image_inverted (/image_sink)")
    assert mapping.startswith("between clusters: ")
    assert "(100% of all messages) before, 0.0 messages/s and 0 B/s (0% of all messages) after" in (
        mapping
    )
    assert mapping.endswith(": less")
