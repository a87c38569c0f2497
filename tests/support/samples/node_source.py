# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The source of a node with one endpoint, to be read and not run."""

from __future__ import annotations

_SOURCE = """\
from rclpy.node import Node
from std_msgs.msg import {types}
class Example(Node):
    def __init__(self):
        super().__init__("{name}")
        self.create_{kind}(String, {topic}, 10)
"""


def node_source(
    name: str = "talker",
    kind: str = "publisher",
    *,
    topic: str = '"chatter"',
    types: str = "String",
) -> str:
    """Return the source; `topic` is an expression, `types` are imported from std_msgs."""
    return _SOURCE.format(name=name, kind=kind, topic=topic, types=types)
