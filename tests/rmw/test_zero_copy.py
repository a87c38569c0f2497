# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Large arrays of messages without copies: what is taken and published stays as it was."""

from __future__ import annotations

import _imp
import array
import copy
import json
import os
import pickle
import random
import shutil
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rclpy
from geometry_msgs.msg import Point
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import CompressedImage, Image, PointCloud2
from std_msgs.msg import UInt8MultiArray
from visualization_msgs.msg import Marker

import rmw_manycore_arrays as arrays
from rmw_manycore_py.native._transport import Platform
from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.nodes.exchanging import Exchange, in_record, large, status_of_child
from support.nodes.ros import announce, lost_messages, peer_node, spin_until
from support.processes.platforms import PLATFORMS, environment, unique_platform

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="others copy")

TESTS = Path(__file__).parents[1]
DEPTH = 4
BESIDE_DEPTH = 4  # held as well, see docs/design/holds.md
MANY = 200


def run(*arguments: str, **variables: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, *arguments],
        env=environment(unique_platform(), PYTHONPATH=str(TESTS), **variables),
        capture_output=True,
        text=True,
        timeout=3 * TIMEOUT_S,  # for messages of all types
        check=False,
    )


def compared(**variables: str) -> dict[str, dict[str, Any]]:
    done = run("-m", "support.comparisons.messages", **variables)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_every_type_as_with_copies():
    found = compared()
    copied = compared(**{arrays.VARIABLE: arrays.OFF})
    assert sum(one["in_record"] for one in found.values()) > 100
    assert sum(one["in_record"] for one in copied.values()) == 0
    for report in ("hash", "damaged"):
        same = {name: one[report] for name, one in copied.items()}
        assert {name: one[report] for name, one in found.items()} == same
    assert len(found) > 30


def test_invalid_setting_is_rejected():
    done = run("-c", "import rclpy", **{arrays.VARIABLE: "always"})
    assert (
        done.stderr
        == "MANYCORE_ZERO_COPY='always' is not valid: expected sole or read_only or off\n"
    )
    assert done.returncode == 1


def test_programs_on_other_middlewares_load_nothing_of_it():
    code = "import sys, rmw_manycore_hook; print('rmw_manycore_arrays' in sys.modules)"
    assert run("-c", code, RMW_IMPLEMENTATION="rmw_fastrtps_cpp").stdout == "False\n"


def test_the_message_around_an_array_is_whole(node):
    received: list[Any] = []
    publisher = node.create_publisher(Image, "image", DEPTH)
    node.create_subscription(Image, "image", received.append, DEPTH)
    spin_until(node, publisher.get_subscription_count)
    message = Image(height=3, encoding="rgb8", data=large())
    message.header.frame_id = "camera"
    publisher.publish(message)
    spin_until(node, lambda: received)
    assert in_record(received[0].data)
    assert received[0] == message
    copies = [copy.deepcopy(received[0]), pickle.loads(pickle.dumps(received[0]))]
    assert copies == [message, message]
    assert {type(one.data) for one in copies} == {array.array}
    publisher.publish(received[0])
    spin_until(node, lambda: len(received) == 2)
    assert received[1] == message


class OwnData:
    """Its property returns other values than the slot of the generated class holds."""

    @property
    def data(self) -> Any:
        return large(seed=5)

    @data.setter
    def data(self, value: Any) -> None:
        self._data = value


class Derived(OwnData, UInt8MultiArray):
    pass


class DerivedImage(OwnData, CompressedImage):
    pass


@pytest.mark.parametrize(
    "value", [large().tobytes(), np.frombuffer(large(), np.uint8), list(large())]
)
def test_fields_that_are_no_array_are_published_as_upstream(node, value):
    exchange = Exchange(node)
    message = UInt8MultiArray()
    message._data = value
    exchange.publisher.publish(message)
    spin_until(node, lambda: exchange.taken)
    assert exchange.taken[0].data == large()


def test_a_derived_class_is_published_as_upstream():
    message = Derived()
    message._data = large(seed=6)
    assert deserialize_message(serialize_message(message), UInt8MultiArray).data == large(seed=5)


def test_a_nested_message_of_a_derived_class_is_published_as_upstream():
    marker = Marker(texture=DerivedImage())
    marker.texture._data = large(seed=6)
    assert deserialize_message(serialize_message(marker), Marker).texture.data == large(seed=5)


def test_a_published_array_is_free_again(node):
    exchange = Exchange(node)
    message = UInt8MultiArray(data=large())
    exchange.publisher.publish(message)
    message.data.append(1)
    message.data[0] ^= 1
    spin_until(node, lambda: exchange.taken)
    assert exchange.taken[0].data == large()


def test_a_failed_conversion_leaves_the_array_free(node):
    publisher = node.create_publisher(PointCloud2, "cloud", DEPTH)
    message = PointCloud2(data=large(), fields=[Point()])
    message.width = "wide"
    with pytest.raises((AssertionError, SystemError, TypeError)):
        publisher.publish(message)
    message.data.append(1)


def test_a_reader_that_writes_changes_nothing_for_others(node, start_peer):
    peer = start_peer(take_and_write, MANY, cluster=2)
    exchange = Exchange(node)
    others: list[Any] = []
    node.create_subscription(UInt8MultiArray, "large", others.append, 10)
    spin_until(node, lambda: exchange.publisher.get_subscription_count() == 3)
    for number in range(MANY):
        values = large(seed=number)
        found = exchange(values)
        assert found == values
        np.frombuffer(found, np.uint8)[:] = 0
        spin_until(node, lambda: others)
        assert others.pop(0).data == values
        peer.wait_for(f"^{number} True$")


def take_and_write(count: int) -> None:
    with peer_node() as node:
        taken: list[Any] = []
        node.create_subscription(UInt8MultiArray, "large", taken.append, 10)
        for number in range(count):
            spin_until(node, lambda: taken)
            data = taken.pop(0).data
            announce(f"{number} {data == large(seed=number)}")
            data[:] = array.array("B", bytes(len(data)))


def test_held_messages_stay_as_they_were(node):
    """Those beyond the depth and a few are copies."""
    exchange = Exchange(node, depth=DEPTH)
    held = [exchange(large(seed=number)) for number in range(MANY)]
    assert sum(in_record(values) for values in held) == DEPTH + BESIDE_DEPTH
    assert [number for number in range(MANY) if held[number] != large(seed=number)] == []
    for number in range(0, MANY, 2):
        held[number] = exchange(large(seed=MANY + number))
    same = [large(seed=number + MANY * (number % 2 == 0)) for number in range(MANY)]
    assert held == same


def test_random_holds(node):
    source = random.Random(1)
    exchange = Exchange(node, depth=DEPTH)
    held: dict[int, Any] = {}
    for number in range(MANY):
        size = source.choice((1_000, 66_000, 300_000))
        held[number] = exchange(large(seed=number, size_bytes=size))
        for old in source.sample(sorted(held), source.randrange(min(4, len(held)))):
            values = held.pop(old)
            assert values == large(seed=old, size_bytes=len(values))


@pytest.mark.parametrize("is_killed", [False, True], ids=["leaves", "killed"])
def test_arrays_outlive_everything(start_peer, peer_cluster, is_killed):
    peer = start_peer(publish_until_stopped, cluster=peer_cluster)
    rclpy.init()
    node = rclpy.create_node("tester")
    received: list[Any] = []
    subscription = node.create_subscription(UInt8MultiArray, "large", received.append, DEPTH)
    spin_until(node, lambda: len(received) >= 3)
    held = received[:3]
    node.destroy_subscription(subscription)
    if is_killed:
        peer.kill()
    else:
        peer.say("end")
        assert peer.wait() == 0
    node.destroy_node()
    rclpy.shutdown()
    assert [one.data for one in held] == [large()] * 3
    held[0].data[0] ^= 1
    held[1].data.append(1)
    assert held[2].data == large()


def publish_until_stopped() -> None:
    with peer_node() as node:
        publisher = node.create_publisher(UInt8MultiArray, "large", DEPTH)
        node.create_timer(0.01, lambda: publisher.publish(UInt8MultiArray(data=large())))
        spin_until(node, publisher.get_subscription_count)
        spin_until(node, lambda: not publisher.get_subscription_count())
        sys.stdin.readline()


def test_arrays_outlive_their_platform(start_peer):
    peer = start_peer(hold_beyond_the_platform)
    assert peer.wait() == 0
    assert "same" in peer.lines


def hold_beyond_the_platform() -> None:
    with peer_node() as node:
        values = Exchange(node)(large())
        assert in_record(values)
        shutil.rmtree(PLATFORMS / os.environ["MANYCORE_PLATFORM"])
        values[0] ^= 1
        values.append(1)
        values[0] ^= 1
        announce("same" if values[:-1] == large() else "different")


def test_damaged_messages_are_dropped(node):
    exchange = Exchange(node)
    cdr = serialize_message(UInt8MultiArray(data=large()))
    source = random.Random(1)
    length = cdr.index(len(large()).to_bytes(4, "little"))
    damaged = [cdr[:length] + (0x7FFFFFFF).to_bytes(4, "little") + cdr[length + 4 :]]
    damaged += [cdr[: len(cdr) - source.randrange(1, 30_000)] for _ in range(10)]
    damaged += [b"\0\x55" + cdr[2:]]
    for one in damaged:
        exchange.publisher.publish(one)
        assert exchange(large()) == large()
    assert lost_messages("/large") == len(damaged)


def test_the_other_byte_order_is_copied(node):
    exchange = Exchange(node, typecode="d")
    values = large("d")
    cdr = bytearray(serialize_message(exchange.kind(data=values)))
    cdr[1] ^= 1
    words = np.frombuffer(cdr, np.uint32, 3, 4)
    words.byteswap(inplace=True)
    np.frombuffer(cdr, np.float64, len(values), 4 + 16).byteswap(inplace=True)
    exchange.publisher.publish(bytes(cdr))
    spin_until(node, lambda: exchange.taken)
    assert exchange.taken[0].data == values
    assert type(exchange.taken[0].data) is array.array


@pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork:DeprecationWarning")
def test_a_child_keeps_what_it_inherits(node):
    exchange = Exchange(node, depth=DEPTH)
    held = [exchange(large(seed=number)) for number in range(DEPTH)]
    view = np.frombuffer(held[0], np.uint8)
    read_end, write_end = os.pipe()
    child = os.fork()
    if child == 0:
        status = 1
        try:
            os.read(read_end, 1)
            assert [large(seed=number) for number in range(DEPTH)] == held
            assert bytes(view) == large(seed=0).tobytes()
            view[0] ^= 1
            held[1].append(1)
            held.clear()
            status = 0
        finally:
            os._exit(status)
    before = view[0]
    view[:] = 0
    del view
    held.clear()
    for number in range(2 * DEPTH):  # into the records that were given back
        exchange(large(seed=MANY + number))
    os.write(write_end, b"x")
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    assert before == large(seed=0)[0]


@pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork:DeprecationWarning")
def test_a_child_of_a_child(node):
    held = Exchange(node)(large())

    def look() -> None:
        assert held == large()
        held[0] ^= 1
        assert status_of_child(lambda: held.append(1)) == 0
        assert held[0] != large()[0]

    assert status_of_child(look) == 0
    assert held == large()


@pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork:DeprecationWarning")
def test_threads_that_fork_at_the_same_time(node):
    """Each waits for its own child, and no end of a pipe stays open in any process."""
    held = Exchange(node)(large())
    before = open_files()
    statuses: list[int] = []

    def fork() -> None:
        statuses.append(status_of_child(look))

    def look() -> None:
        assert held == large()
        assert open_files() == before

    threads = [threading.Thread(target=fork) for _ in range(2)]
    _imp.acquire_lock()  # os.fork() takes it after the functions that are called before a fork
    try:
        for thread in threads:
            thread.start()
        wait_until(lambda: open_files() == before + 2 * len(threads), "both threads have a pipe")
    finally:
        _imp.release_lock()
    for thread in threads:
        thread.join()
    assert statuses == [0, 0]
    assert open_files() == before


def open_files() -> int:
    return len(os.listdir("/proc/self/fd"))


def test_messages_that_are_read_in_place_are_counted(node):
    exchange = Exchange(node)
    for values in (large(seed=1), array.array("B", b"small"), large(seed=2)):
        assert exchange(values) == values
    found = Platform(os.environ["MANYCORE_PLATFORM"]).endpoints()
    counters = {e.kind: e.counters for e in found if e.topic == "/large"}
    assert {kind: one.messages for kind, one in counters.items()} == {
        "publisher": 3,
        "subscription": 3,
    }
    assert counters["subscription"].in_place == 2
    assert counters["publisher"].in_place == 0
