# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publishes and takes messages of all installed types with sequences of numbers.

    python messages_compared.py

Run with and without MANYCORE_ZERO_COPY=off, it prints the same, but for `in_record`.
Prints, as JSON, by type: a hash of what is published and of what is taken, and how many arrays of
the taken messages lie in a record.
"""

from __future__ import annotations

import array
import hashlib
import json
import random
import sys
from typing import Any

import rclpy
from made_messages import classes_with_number_fields, made_message, value_at
from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message
from ros_support import spin_until

import rmw_manycore_arrays as arrays

ROUNDS = 3


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
