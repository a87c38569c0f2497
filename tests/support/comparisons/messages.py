# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publishes and takes messages of all installed types with sequences of numbers.

    python -m support.comparisons.messages

Run with and without MANYCORE_ZERO_COPY=off, it prints the same, but for `in_record`.
Prints, as JSON, by type: a hash of what is published and taken, another one of what is taken of
damaged messages, and how many arrays of the taken messages lie in a record.
"""

from __future__ import annotations

import array
import hashlib
import json
import random
import sys
from typing import Any

import rclpy
from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message

import rmw_manycore_arrays as arrays
from support.generated.messages import classes_with_number_fields, made_message, value_at
from support.nodes.ros import spin_until

ROUNDS = 3
DAMAGED = 6
EDGE_BYTES = 300  # at either end of a message, where its lengths and strings are


def exchanged(node: Node, message: Any, sent: list[Any]) -> list[Any]:
    """Publish messages and return what a subscription gets."""
    taken: list[Any] = []
    publisher = node.create_publisher(message, "compared", len(sent))
    subscription = node.create_subscription(message, "compared", taken.append, len(sent))
    spin_until(node, publisher.get_subscription_count)
    for one in sent:
        publisher.publish(one)
    spin_until(node, lambda: len(taken) == len(sent))
    node.destroy_subscription(subscription)
    node.destroy_publisher(publisher)
    return taken


def damaged(cdr: bytes, source: random.Random) -> bytes:
    """Return a CDR with a few other bytes outside of most arrays, sometimes without its end."""
    changed = bytearray(cdr)
    for _ in range(source.randrange(1, 4)):
        at = source.randrange(min(EDGE_BYTES, len(cdr)))
        changed[source.choice((at, -1 - at))] = source.choice((0, 1, 127, 255))
    return bytes(changed[: len(cdr) - source.choice((0, 0, 1, 7, 70_000))])


def taken_of_damaged(node: Node, message: Any, source: random.Random) -> str:
    """Return a hash of what is taken of damaged messages, or which error it raises."""
    digest = hashlib.sha256()
    publisher = node.create_publisher(message, "damaged", 10)
    subscription = node.create_subscription(message, "damaged", print, 10)
    spin_until(node, publisher.get_subscription_count)
    last = message()
    for _ in range(DAMAGED):
        whole = serialize_message(made_message(message, source, is_large=True))
        publisher.publish(damaged(whole, source))
        publisher.publish(last)
        taken: Any = None
        while not (taken and taken[0] == last):
            try:
                taken = subscription.handle.take_message(message, False)
            except Exception as error:
                digest.update(repr(type(error)).encode())
            else:
                digest.update(repr(taken[0]).encode() if taken else b"")
    node.destroy_subscription(subscription)
    node.destroy_publisher(publisher)
    return digest.hexdigest()


def hash_of(messages: list[Any]) -> str:
    """Return a hash of the values, as Python sees them, and of the CDR."""
    digest = hashlib.sha256()
    for message in messages:
        digest.update(repr(message).encode())
        digest.update(serialize_message(message))
    return digest.hexdigest()


def compare(node: Node, message: Any) -> dict[str, Any]:
    source = random.Random(message.__name__)
    sent = [made_message(message, source, is_large=True) for _ in range(ROUNDS)]
    taken = exchanged(node, message, sent)
    assert taken == sent, message
    assert [deserialize_message(serialize_message(one), message) for one in sent] == sent, message
    found = [value_at(one, path) for one in taken for path, _, _ in arrays.number_fields(message)]
    assert all(isinstance(value, array.array) for value in found)
    return {
        "hash": hash_of(taken),
        "damaged": taken_of_damaged(node, message, source),
        "in_record": sum(type(value) is not array.array for value in found),
    }


def main() -> None:
    rclpy.init()
    node = rclpy.create_node("compared")
    report = {
        f"{message.__module__}.{message.__name__}": compare(node, message)
        for message in classes_with_number_fields()
    }
    json.dump(report, sys.stdout)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
