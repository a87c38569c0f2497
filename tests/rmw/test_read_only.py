# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""zero_copy: read_only, by variable and by topic: all readers see one record, and none writes."""

from __future__ import annotations

import array
import copy
import io
import os
import pickle
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import rclpy
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import CompressedImage  # converted by none before, see `preload`

import rmw_manycore_arrays as arrays
from rmw_manycore_py.native import _transport
from support import IS_MANYCORE
from support.nodes.exchanging import in_record, large, status_of_child
from support.nodes.ros import announce, peer_node, spin_until

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="others copy")

READ_ONLY = {arrays.VARIABLE: arrays.READ_ONLY}
TOPIC = "large"
SUBSCRIPTIONS = 3
DEPTH = 4
CHANGES: list[Callable[[Any], Any]] = [
    lambda values: values.__setitem__(0, 1),
    lambda values: values.__setitem__(slice(0, 2), array.array("B", b"ab")),
    lambda values: values.__delitem__(0),
    lambda values: values.__iadd__(array.array("B", b"a")),
    lambda values: values.__imul__(2),
    lambda values: values.append(1),
    lambda values: values.extend(b"a"),
    lambda values: values.frombytes(b"a"),
    lambda values: values.pop(),
    lambda values: values.reverse(),
    lambda values: values.byteswap(),
]


def taken_by(node: Node, count: int, qos: QoSProfile | int = DEPTH) -> list[Any]:
    """Return the arrays that `count` subscriptions take of one message of another process."""
    taken: list[list[Any]] = [[] for _ in range(count)]
    for each in taken:
        node.create_subscription(CompressedImage, TOPIC, each.append, qos)
    spin_until(node, lambda: all(taken))
    return [each[0].data for each in taken]


def check(report: str) -> None:
    """Run a function of this file in a node."""
    with peer_node() as node:
        globals()[report](node)
        announce("checked")


def see_one_record(node: Node) -> None:
    found = taken_by(node, SUBSCRIPTIONS)
    assert all(in_record(values) and values == large() for values in found)
    assert len({values.buffer_info()[0] for values in found}) == 1
    for values in found:
        seen = np.frombuffer(values, np.uint8)
        assert not seen.flags.writeable
        assert not np.ndarray(len(values), np.uint8, buffer=values).flags.writeable
        assert memoryview(values).readonly
        with pytest.raises(ValueError, match="read-only"):
            seen[0] = 1


def refuse_changes(node: Node) -> None:
    (values,) = taken_by(node, 1)
    for change in CHANGES:
        with pytest.raises(TypeError, match=r"read-only.*zero_copy: read_only.*array\[:\]"):
            change(values)
    with pytest.raises((BufferError, TypeError)):
        io.BytesIO(b"a").readinto(values)
    assert values == large()


def copy_to_change(node: Node) -> None:
    (values,) = taken_by(node, 1)
    copies = [values[:], copy.copy(values), copy.deepcopy(values)]
    copies += [pickle.loads(pickle.dumps(values))]
    for one in copies:
        one[0] ^= 1
        one.append(1)
    assert values == large()
    assert status_of_child(lambda: check_in_child(values)) == 0


def check_in_child(values: Any) -> None:
    assert values == large()
    with pytest.raises(TypeError):
        values[0] = 1


def publish_again(node: Node) -> None:
    (values,) = taken_by(node, 1)
    publisher = node.create_publisher(CompressedImage, "again", DEPTH)
    taken: list[Any] = []
    node.create_subscription(CompressedImage, "again", taken.append, DEPTH)
    spin_until(node, publisher.get_subscription_count)
    publisher.publish(CompressedImage(data=values))
    spin_until(node, lambda: taken)
    assert taken[0].data == large()


@pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork:DeprecationWarning")
@pytest.mark.parametrize(
    "report", ["see_one_record", "refuse_changes", "copy_to_change", "publish_again"]
)
def test_by_variable(node, start_peer, report):
    publisher = node.create_publisher(CompressedImage, TOPIC, DEPTH)
    peer = start_peer(check, report, cluster=2, **READ_ONLY)
    count = SUBSCRIPTIONS if report == "see_one_record" else 1
    spin_until(node, lambda: publisher.get_subscription_count() == count)
    publisher.publish(CompressedImage(data=large()))
    peer.wait_for("^checked$")


def test_messages_of_a_history(node, start_peer):
    """A late reader sees the record that the first one holds."""
    qos = QoSProfile(depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_publisher(CompressedImage, TOPIC, qos).publish(CompressedImage(data=large()))
    start_peer(check, "see_history", cluster=2, **READ_ONLY).wait_for("^checked$")


def see_history(node: Node) -> None:
    qos = QoSProfile(depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    (first,) = taken_by(node, 1, qos)
    (second,) = taken_by(node, 1, qos)
    assert first == second == large()
    assert first.buffer_info() == second.buffer_info()


def test_a_sole_reader_beside_does_not_write_into_the_record(node, start_peer):
    """It has a copy of a message for several readers."""
    publisher = node.create_publisher(CompressedImage, TOPIC, DEPTH)
    peer = start_peer(check, "keep_and_compare", cluster=2, **READ_ONLY)
    taken: list[Any] = []
    node.create_subscription(CompressedImage, TOPIC, taken.append, DEPTH)
    spin_until(node, lambda: publisher.get_subscription_count() == 2)
    publisher.publish(CompressedImage(data=large()))
    spin_until(node, lambda: taken)
    np.frombuffer(taken[0].data, np.uint8)[:] = 0
    peer.wait_for("^taken$")
    peer.say("compare")
    peer.wait_for("^checked$")


def keep_and_compare(node: Node) -> None:
    (values,) = taken_by(node, 1)
    assert in_record(values)
    announce("taken")
    sys.stdin.readline()
    assert values == large()


@pytest.mark.parametrize("mode", ["sole", "read_only", "off"])
def test_the_topic_decides_before_the_variable(start_peer, mode):
    start_peer(configure, mode).wait_for("configured")
    variable = arrays.SOLE if mode == arrays.READ_ONLY else arrays.READ_ONLY
    report = {"sole": "write", "off": "own"}.get(mode, "refuse_changes")
    peer = start_peer(check, report, **{arrays.VARIABLE: variable})
    rclpy.init()
    node = rclpy.create_node("tester")
    publisher = node.create_publisher(CompressedImage, TOPIC, DEPTH)
    spin_until(node, publisher.get_subscription_count)
    publisher.publish(CompressedImage(data=large()))
    peer.wait_for("^checked$")
    node.destroy_node()
    rclpy.shutdown()


def configure(mode: Any) -> None:
    topic = _transport.TopicConfiguration(
        f"/{TOPIC}", id=1, dsm_size_bytes=0, receiver_clusters=0, zero_copy=mode
    )
    with _transport.Configurator(
        os.environ["MANYCORE_PLATFORM"],
        clusters=2,
        cores_per_cluster=4,
        smem_bytes=0,
        host_cpu_of_receive_thread={},
        topics=[topic],
    ):
        announce("configured")
        sys.stdin.read()


def write(node: Node) -> None:
    (values,) = taken_by(node, 1)
    assert in_record(values)
    values[0] ^= 1


def own(node: Node) -> None:
    (values,) = taken_by(node, 1)
    assert type(values) is array.array
