# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Platforms to draw, and how rectangles lie."""

from __future__ import annotations

import random
from typing import Any

from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.picture.geometry import Rect
from rmw_manycore_py.platform.monitor.graph import Endpoint, Graph, Member
from rmw_manycore_py.ros.qos import policies_of

QOS = policies_of(Qos())


def member(slot: int, cluster: int, core: int | None, *nodes: str) -> Member:
    """Return a process with these nodes."""
    return Member(slot, 100 + slot, cluster, core, None, f"program {slot}", nodes)


def graph(members: list[Member], ends: list[tuple[Any, str, int]] | None = None) -> Graph:
    """Return a graph of Coolidge's size; ends are kind, topic, and index of the member."""
    endpoints = tuple(
        Endpoint(n, kind, "topic", topic, "T", members[i].nodes[0], members[i].slot, QOS)
        for n, (kind, topic, i) in enumerate(ends or [])
    )
    return Graph("p", 5, 16, 1 << 20, tuple(members), endpoints)


def mapping(seed: int, nodes: int) -> Graph:
    """Return nodes at random places: pipelines, a topic for all, and topics of some."""
    chance = random.Random(seed)
    clusters = chance.randint(1, 5)
    members = [
        member(
            slot,
            chance.randint(1, clusters),
            chance.choice([None, *range(16)]),
            f"/{'robot/' * chance.randint(0, 2)}node_{slot}",
        )
        for slot in range(nodes)
    ]
    ends = [("publisher", "/clock", 0)]
    ends += [("subscription", "/clock", slot) for slot in range(nodes)]
    for slot in range(nodes - 1):
        topic = f"/pipe_{slot}/{'long_' * chance.randint(0, 8)}name"
        others = chance.sample(range(nodes), chance.randint(1, min(3, nodes)))
        ends.append(("publisher", topic, slot))
        ends += [("subscription", topic, other) for other in {slot + 1, *others}]
    return graph(members, ends)


def inside(inner: Rect, outer: Rect) -> bool:
    """Return whether a rectangle lies in another one."""
    return (
        inner.x >= outer.x
        and inner.y >= outer.y
        and inner.right <= outer.right
        and inner.bottom <= outer.bottom
    )


def apart(one: Rect, other: Rect) -> bool:
    """Return whether two rectangles have at most an edge in common."""
    return (
        one.right <= other.x
        or other.right <= one.x
        or one.bottom <= other.y
        or other.bottom <= one.y
    )
