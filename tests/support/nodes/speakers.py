# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes that publish texts and that print received texts, on either side of a bridge."""

from __future__ import annotations

import itertools
import os
import signal
import struct
import time
from typing import Any

from support.nodes.ros import announce, peer_node, spin_until, type_of

STRING = "std_msgs/msg/String"


def qos(words: dict[str, Any]) -> Any:
    """Return a profile from names of policies, as JSON contains them."""
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    durability = DurabilityPolicy[words.get("durability", "volatile").upper()]
    reliability = ReliabilityPolicy[words.get("reliability", "reliable").upper()]
    times = {key: Duration(nanoseconds=words[key]) for key in ("deadline",) if key in words}
    depth = words.get("depth", 10)
    return QoSProfile(depth=depth, durability=durability, reliability=reliability, **times)


def say(topic: str, words: dict[str, Any], period_s: float | None, *texts: str) -> None:
    """Publish texts at once, and, with a period, the time forever, once a period."""
    with peer_node("speaker") as node:
        publisher = node.create_publisher(type_of(STRING), topic, qos(words))
        message = type_of(STRING)
        for text in texts:
            publisher.publish(message(data=text))
        if period_s:

            def say_time() -> None:
                publisher.publish(message(data=f"again {time.time_ns()}"))

            node.create_timer(period_s, say_time)
        announce("said")
        spin_until(node, lambda: False, 1e6)


def count_up(topic: str, words: dict[str, Any], period_s: float) -> None:
    """Publish the numbers from 0."""
    with peer_node("counter") as node:
        message = type_of(STRING)
        publisher = node.create_publisher(message, topic, qos(words))
        numbers = itertools.count()
        node.create_timer(period_s, lambda: publisher.publish(message(data=str(next(numbers)))))
        announce("counting")
        spin_until(node, lambda: False, 1e6)


def hear(topic: str, words: dict[str, Any]) -> None:
    """Print each message received, with its source timestamp."""
    with peer_node("hearer") as node:

        def heard(message: Any, info: Any) -> None:
            announce(f"heard {message.data} {info['source_timestamp']}")

        node.create_subscription(type_of(STRING), topic, heard, qos(words))
        announce("listening")
        spin_until(node, lambda: False, 1e6)


def flood(topic: str) -> None:
    """Publish much more than the buffers of a slow link or a stopped subscriber hold."""
    with peer_node("flooder") as node:
        message = type_of(STRING)(data="x" * 200_000)
        publisher = node.create_publisher(type_of(STRING), topic, 10)
        node.create_timer(0.005, lambda: publisher.publish(message))
        announce("flooding")
        spin_until(node, lambda: False, 1e6)


def answer(topic: str, answers: str, window: int) -> None:
    """Publish an answer to each message, once answers have a subscription; `flood_by_answers`."""
    with peer_node("answerer") as node:
        publisher = node.create_publisher(type_of(STRING), answers, window)
        spin_until(node, publisher.get_subscription_count)

        def heard(_: Any) -> None:
            publisher.publish(type_of(STRING)(data="heard"))
            announce("answered")

        node.create_subscription(type_of(STRING), topic, heard, window)
        spin_until(node, lambda: False, 1e6)


def flood_by_answers(topic: str, answers: str, window: int, n_subscriptions: int) -> None:
    """Publish, from SIGUSR1 on, as fast as one subscriber answers.

    At most `window` messages are under way to it: it loses none, however slow it is.
    """
    told: list[int] = []
    signal.signal(signal.SIGUSR1, lambda number, _: told.append(number))
    with peer_node("flooder") as node:
        message = type_of(STRING)(data="x" * 50_000)
        publisher = node.create_publisher(type_of(STRING), topic, window)
        node.create_subscription(
            type_of(STRING), answers, lambda _: publisher.publish(message), window
        )
        spin_until(node, lambda: publisher.get_subscription_count() == n_subscriptions)
        announce("ready")
        spin_until(node, lambda: told)
        for _ in range(window):
            publisher.publish(message)
        spin_until(node, lambda: False, 1e6)


def say_as(name: str, topic: str, words: dict[str, Any]) -> None:
    """Publish the node's name, again and again."""
    with peer_node(name) as node:
        message = type_of(STRING)(data=name)
        publisher = node.create_publisher(type_of(STRING), topic, qos(words))
        node.create_timer(0.05, lambda: publisher.publish(message))
        announce("said")
        spin_until(node, lambda: False, 1e6)


def _text(name: str) -> bytes:
    return struct.pack("<xBxxI", 1, len(name) + 1) + name.encode() + b"\0"


def say_as_many(count: int, topic: str) -> None:
    """Publish the names of nodes, each on its own, from the moment on when it has a publisher.

    Beside them a node comes, says its name and goes, again and again.
    """
    from rmw_manycore_py.native import _transport

    with _transport.Process(os.environ["MANYCORE_PLATFORM"], label="voices") as process:

        def voice(name: str) -> _transport.Publisher:
            node = process.node(name, "/")
            publisher = process.publisher(topic, STRING, _transport.Qos(), node=node)
            publisher.publish(_text(name))
            return publisher

        voices = {f"voice{number}": voice(f"voice{number}") for number in range(count)}
        announce("said")
        for number in itertools.count():
            voice(f"guest{number}")
            for name, publisher in voices.items():
                publisher.publish(_text(name))
            process.wait(process.epoch(), 0.05)


def hear_gids(topic: str, count: int) -> None:
    """Print the nodes of several publishers that stay, once each one's texts have been heard.

    The texts are the names of the nodes, and their gids are those of these nodes. The last text of
    a publisher that ends may be the bridge's.
    """
    from rmw_manycore_py.native import _transport

    platform = os.environ["MANYCORE_PLATFORM"]
    with _transport.Process(platform, label="gid_hearer") as process:
        heard = process.subscription(topic, STRING, _transport.Qos())
        announce("listening")
        found: set[str] = set()
        while len(found) < count:
            seen = process.epoch()
            while claim := heard.claim():
                gid, text = claim.publisher, claim.data[8:-1].decode()
                claim.release()
                nodes = {e.gid: e.node_name for e in process.endpoints_of(topic)}
                if text.startswith("guest"):
                    assert nodes.get(gid, text) == text or nodes[gid].startswith("_manycore_bridge")
                else:
                    assert nodes[gid] == text
                    found.add(text)
            process.wait(seen, 1.0)
        announce(f"heard {' and '.join(sorted(found))} from their gids")
        heard.close()


def count_as_many(count: int, topic: str) -> None:
    """Publish the numbers from 0, each with the name of its node, on several nodes."""
    from rmw_manycore_py.native import _transport

    with _transport.Process(os.environ["MANYCORE_PLATFORM"], label="counters") as process:
        nodes = {
            f"counter{number}": process.node(f"counter{number}", "/") for number in range(count)
        }
        publishers = {
            name: process.publisher(topic, STRING, _transport.Qos(depth=1000), node=node)
            for name, node in nodes.items()
        }
        for number in itertools.count():
            for name, publisher in publishers.items():
                publisher.publish(_text(f"{name} {number}"))
            process.wait(process.epoch(), 0.1)


def count_among_newcomers(count: int, topic: str) -> None:
    """Publish the numbers from 0, while more and more publishers of the topic come."""
    from rmw_manycore_py.native import _transport

    with _transport.Process(os.environ["MANYCORE_PLATFORM"], label="counter") as process:
        own = process.publisher(topic, STRING, _transport.Qos(depth=1000))
        newcomers = []
        for number in itertools.count():
            own.publish(_text(f"counter {number}"))
            if number % 50 == 49 and len(newcomers) < count:
                newcomers.append(process.publisher(topic, STRING, _transport.Qos()))
            if number == 50 * (count + 2):
                announce("all came")
            process.wait(process.epoch(), 0.002)


def hear_counters(topic: str, count: int) -> None:
    """Print when all counters have been heard anew, and on SIGUSR1 how many numbers are missing.

    No number is heard twice.
    """
    from rmw_manycore_py.native import _transport

    asked: list[int] = []
    signal.signal(signal.SIGUSR1, lambda number, _: asked.append(number))
    with _transport.Process(os.environ["MANYCORE_PLATFORM"], label="counters_hearer") as process:
        heard = process.subscription(topic, STRING, _transport.Qos(depth=10_000))
        announce("listening")
        last: dict[str, int] = {}
        anew: set[str] = set()
        missing = 0
        while not asked:
            seen = process.epoch()
            while claim := heard.claim():
                name, number = claim.data[8:-1].decode().split()
                claim.release()
                before = last.get(name, int(number) - 1)
                assert int(number) > before
                missing += int(number) - before - 1
                last[name] = int(number)
                anew.add(name)
            if len(anew) == count:
                announce("heard all")
                anew.clear()
            process.wait(seen, 0.1)
        announce(f"missing {missing} lost {heard.lost()}")
        heard.close()


def say_stamped(topic: str, stamp_ns: int) -> None:
    """Publish a text again and again, as at one time of another clock."""
    from rmw_manycore_py.native import _transport

    with _transport.Process(os.environ["MANYCORE_PLATFORM"], label="stamper") as process:
        publisher = process.publisher(topic, STRING, _transport.Qos())
        while True:
            publisher.publish(_text("then"), stamp_ns)
            process.wait(process.epoch(), 0.05)
