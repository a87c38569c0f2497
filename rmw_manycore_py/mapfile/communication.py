# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Proposes clusters by communication: nodes that exchange messages share a cluster."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Iterable, Mapping, Sequence
from typing import TypeVar

Node = TypeVar("Node", bound=Hashable)
Talk = Mapping[tuple[Node, Node], float]


def talk_of(
    publishers: Iterable[tuple[Node, str, float]], subscribers: Iterable[tuple[Node, str]]
) -> Talk[Node]:
    """Return how much each two nodes exchange, once for each direction.

    :param publishers: node, topic, and messages or another weight.
    :param subscribers: node and topic.
    """
    readers: dict[str, set[Node]] = {}
    for reader, topic in subscribers:
        readers.setdefault(topic, set()).add(reader)
    talk: dict[tuple[Node, Node], float] = defaultdict(float)
    for writer, topic, weight in publishers:
        for reader in readers.get(topic, set()) - {writer}:
            talk[writer, reader] += weight
            talk[reader, writer] += weight
    return talk


def by_communication(
    nodes: Sequence[Node], talk: Talk[Node], room: Mapping[int, int]
) -> dict[Node, int]:
    """Return the cluster of each node, as far as there is room.

    A group of nodes that reach each other by topics goes into the first cluster that holds all of
    it. If none does, the cluster with most room gets those that exchange the most.

    :param room: nodes that each cluster has room for.
    """
    left = dict(room)
    clusters: dict[Node, int] = {}
    groups = _groups(nodes, talk)
    while groups and any(left.values()):
        group = groups.pop(0)
        cluster = next((one for one, free in left.items() if free >= len(group)), None)
        if cluster is None:
            cluster = max(left, key=left.__getitem__)
            part = _closest(group, talk, left[cluster])
            groups[:0] = _groups([node for node in group if node not in part], talk)
            group = part
        left[cluster] -= len(group)
        clusters |= dict.fromkeys(group, cluster)
    return clusters


def _groups(nodes: Sequence[Node], talk: Talk[Node]) -> list[list[Node]]:
    """Return the connected groups, each in the order of the nodes."""
    group = {node: {node} for node in nodes}
    for one, other in talk:
        if one in group and other in group and group[one] is not group[other]:
            group[one] |= group[other]
            for node in group[other]:
                group[node] = group[one]
    found = {id(members): members for members in map(group.__getitem__, nodes)}
    return [[node for node in nodes if node in members] for members in found.values()]


def _closest(group: Sequence[Node], talk: Talk[Node], count: int) -> list[Node]:
    """Return the first node, then time and again the one that exchanges most with those chosen."""
    chosen: list[Node] = []
    weights = dict.fromkeys(group, 0.0)
    for _ in range(count):
        node = max(weights, key=weights.__getitem__)
        del weights[node]
        chosen.append(node)
        for other in weights:
            weights[other] += talk.get((node, other), 0.0)
    return chosen
