# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Maps and judgements that the page of `manycore view` shows with the clouds of a topic."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
import rclpy
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import PointCloud2

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.topic.cloud_samples import MAX_MAP_POINTS
from rmw_manycore_py.cli.topic.listening import Listener
from rmw_manycore_py.cli.topic.surroundings import LOOK_PERIOD_S, Surroundings
from rmw_manycore_py.native._transport import EndpointInfo, Platform
from rmw_manycore_py.ndt.messages.point_cloud import encode
from rmw_manycore_py.view.commands import MAX_LINE_BYTES
from support import IS_MANYCORE, wait_until
from support.nodes.ros import peer_node, spin
from support.peers.programs import forked_node

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore")

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def cloud(frame: str, points: Any = ((0, 0, 0),)) -> PointCloud2:
    message: PointCloud2 = encode(np.array(points, np.float64), Time(), frame)
    return message


def publish_latched(node: Node, topic: str, message: PointCloud2) -> Any:
    publisher = node.create_publisher(PointCloud2, topic, LATCHED)
    publisher.publish(message)
    return publisher


class Samples:
    """Publishes /scan on a node, and reads what the page receives of it."""

    def __init__(self, node: Node, start: Callable[..., Any]) -> None:
        self._node = node
        self._skipped = 0
        self._scans = node.create_publisher(PointCloud2, "/scan", 1)
        arguments = (os.environ["MANYCORE_PLATFORM"], "/scan")
        self._program = start(forked_node("rmw_manycore_py.cli.topic.samples", *arguments))
        wait_until(lambda: node.count_subscribers("/scan") == 1, "/scan is subscribed")

    def skip(self) -> None:
        """Forget what was received so far."""
        self._skipped = len(self._program.lines)

    def rows(self, kind: str) -> list[Any]:
        received = self._program.lines[self._skipped :]
        lines = [json.loads(line) for line in received if line.startswith("{")]
        return [line[kind] for line in lines if kind in line]

    def scan(self, frame: str) -> None:
        """Publish a scan, and wait until it is shown."""
        count = len(self.rows("cloud"))
        self._scans.publish(cloud(frame))
        wait_until(lambda: len(self.rows("cloud")) > count, f"the scan in '{frame}' is shown")

    def scan_for(self, duration_s: float) -> None:
        """Scan until the samples are this much younger, by the program's own time."""
        self.scan("map")
        end_s = self.rows("time_s")[-1] + duration_s
        while self.rows("time_s")[-1] < end_s:
            self.scan("map")


@pytest.fixture
def samples(node: Node, start: Callable[..., Any]) -> Samples:
    return Samples(node, start)


class ReadPlatform:
    """A view of a platform that notes how it is read."""

    def __init__(self, opened: Platform) -> None:
        self._opened = opened
        self.generations: list[int] = []
        self.read_count = 0

    def graph_generation(self) -> int:
        self.generations.append(self._opened.graph_generation())
        return self.generations[-1]

    def endpoints(self) -> list[EndpointInfo]:
        self.read_count += 1
        return self._opened.endpoints()


def publish_scan_and_map() -> None:
    with peer_node() as node:
        publishers = [publish_latched(node, topic, cloud("map")) for topic in ("/scan", "/city")]
        assert len(publishers) == 2
        spin(node)


def test_the_graph_is_read_only_after_it_has_changed(start_peer: Callable[..., Any]) -> None:
    start_peer(publish_scan_and_map).wait_for("spinning")
    shown: list[Any] = []
    platform = os.environ["MANYCORE_PLATFORM"]

    def heard(message: Any) -> None:
        surroundings.belong_to(message.header.frame_id)

    def stop_in_time() -> None:
        if shown and read.generations[-6:].count(read.generations[-1]) == 6:
            listener.stop()

    with view.open_platform(platform) as opened:
        read: Any = ReadPlatform(opened)
        listener = Listener(platform, "/scan", None, heard)
        surroundings = Surroundings(listener, read, "/scan", shown.append)
        listener.every(LOOK_PERIOD_S, stop_in_time)
        listener.run()
    assert shown[0]["map"]["topic"] == "/city"
    assert read.read_count == len(set(read.generations))


def test_a_change_of_frame_brings_the_map_of_the_new_one(node: Node, samples: Samples) -> None:
    yard, city = (publish_latched(node, f"/{name}", cloud(name)) for name in ("yard", "city"))
    for count, (frame, other) in enumerate((("city", yard), ("yard", city), ("city", yard)), 1):
        samples.scan(frame)
        wait_until(lambda count=count: len(samples.rows("map")) >= count, f"map of '{frame}'")
        assert samples.rows("map")[-1]["topic"] == f"/{frame}"
        wait_until(lambda other=other: other.get_subscription_count() == 0, "the other is not kept")
    assert len(samples.rows("map")) == 3


def test_a_map_in_another_frame_is_looked_for_again_after_its_restart(
    node: Node, samples: Samples
) -> None:
    city = publish_latched(node, "/city", cloud("odom"))
    samples.scan("map")
    wait_until(lambda: city.get_subscription_count() == 1, "/city is subscribed")
    wait_until(lambda: city.get_subscription_count() == 0, "/city is in another frame")
    node.destroy_publisher(city)
    samples.scan_for(4 * LOOK_PERIOD_S)
    publish_latched(node, "/city", cloud("map"))
    wait_until(lambda: samples.rows("map"), "the new map is shown")


def test_an_equal_map_is_sent_once(node: Node, samples: Samples) -> None:
    city = publish_latched(node, "/city", cloud("map"))
    samples.scan("map")
    wait_until(lambda: samples.rows("map"), "the map is shown")
    for second in range(1, 4):
        same = cloud("map")
        same.header.stamp.sec = second
        city.publish(same)
        samples.scan_for(2 * LOOK_PERIOD_S)
    city.publish(cloud("map", [[0, 0, 5]]))
    wait_until(lambda: samples.rows("map")[-1]["origin"][2] == 5, "another map is shown")
    assert len(samples.rows("map")) == 2


def test_a_map_is_sent_at_most_once_per_look(node: Node, samples: Samples) -> None:
    city = publish_latched(node, "/city", cloud("map"))
    samples.scan("map")
    wait_until(lambda: samples.rows("map"), "the map is shown")
    begin_s, height = time.monotonic(), 0

    def has_newer_maps() -> bool:
        nonlocal height
        height += 1
        city.publish(cloud("map", [[0, 0, height]]))
        return len(samples.rows("map")) >= 5

    wait_until(has_newer_maps, "newer maps are shown")
    # A timer of rclpy that is late calls once for all missed periods.
    assert len(samples.rows("map")) - 2 <= (time.monotonic() - begin_s) / LOOK_PERIOD_S


def test_a_large_map_is_thinned(node: Node, samples: Samples) -> None:
    points = np.random.default_rng(1).random((5 * MAX_MAP_POINTS, 3))
    city = publish_latched(node, "/city", cloud("map", points))
    samples.scan("map")
    wait_until(lambda: samples.rows("map"), "the map is shown")
    (row,) = samples.rows("map")
    assert (row["count"], row["shown"]) == (5 * MAX_MAP_POINTS, MAX_MAP_POINTS)
    assert len(json.dumps({"map": row})) < MAX_LINE_BYTES
    assert city.get_subscription_count() == 1


def test_an_empty_map_is_waited_for(node: Node, samples: Samples) -> None:
    city = publish_latched(node, "/city", cloud("map", np.zeros((0, 3))))
    samples.scan("map")
    wait_until(lambda: city.get_subscription_count() == 1, "/city is subscribed")
    samples.scan_for(2 * LOOK_PERIOD_S)
    assert samples.rows("map") == []
    city.publish(cloud("map"))
    wait_until(lambda: samples.rows("map"), "the map is shown")


class Matcher:
    """Publishes scans like a matcher, and its reports."""

    def __init__(self, name: str, namespace: str, scans: str) -> None:
        self._node = rclpy.create_node(name, namespace=namespace)
        self._scans = self._node.create_publisher(PointCloud2, scans, 1)
        self._reports = self._node.create_publisher(DiagnosticArray, "/diagnostics", 10)

    def report(self, message: str) -> None:
        values = {"is_activated": "True", "skipping_publish_num": "1"}
        name = f"{self._node.get_name()}: scan_matching_status"
        pairs = [KeyValue(key=key, value=value) for key, value in values.items()]
        status = DiagnosticStatus(name=name, message=message, values=pairs)
        self._reports.publish(DiagnosticArray(status=[status]))

    def wait_for_judgement(self, samples: Samples, message: str, text: str) -> None:
        """Report until the page shows this."""
        samples.skip()

        def is_shown() -> bool:
            self.report(message)
            return text in [row["text"] for row in samples.rows("judgement")]

        wait_until(is_shown, text)

    def end(self) -> None:
        self._node.destroy_node()


@pytest.fixture
def matcher(samples: Samples) -> Iterator[Matcher]:
    matcher = Matcher("ndt", "/a", "/scan")
    yield matcher
    matcher.end()


def test_a_matcher_of_the_same_name_is_not_mistaken(matcher: Matcher, samples: Samples) -> None:
    matcher.wait_for_judgement(samples, "the score is low", "refused: the score is low")
    other = Matcher("ndt", "/b", "/b/scan")
    unknown = "unknown: several nodes are named 'ndt'"
    other.wait_for_judgement(samples, "the scan is empty", unknown)
    assert "refused: the scan is empty" not in [row["text"] for row in samples.rows("judgement")]
    matcher.wait_for_judgement(samples, "the map is empty", unknown)
    assert {row["text"] for row in samples.rows("judgement")} == {unknown}
    other.end()
    matcher.wait_for_judgement(samples, "there is no map", "refused: there is no map")


def test_other_matchers_are_not_asked(matcher: Matcher, samples: Samples) -> None:
    other = Matcher("other_ndt", "/a", "/b/scan")
    for _ in range(3):
        other.report("the scan is empty")
        matcher.wait_for_judgement(samples, "the score is low", "refused: the score is low")
        assert {row["text"] for row in samples.rows("judgement")} == {"refused: the score is low"}
    other.end()


def test_a_matcher_that_restarts_is_judged_again(matcher: Matcher, samples: Samples) -> None:
    matcher.wait_for_judgement(samples, "the score is low", "refused: the score is low")
    matcher.end()
    again = Matcher("ndt", "/a", "/scan")
    again.wait_for_judgement(samples, "the scan is empty", "refused: the scan is empty")
    again.end()
