# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The skeleton of an application: the endpoints of a profile's nodes, their rates and sizes."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from rmw_manycore_py.bench.scale.sizes import assumed_bytes
from rmw_manycore_py.profile.model import Profile, Publisher

# Each node has them anyway.
OF_EVERY_NODE = ("/parameter_events", "/rosout")
_DEFAULT_DEPTH = 10  # of endpoints without a known one


@dataclass(frozen=True)
class Output:
    """A publisher; its messages come evenly.

    :param rate_hz: of the whole profile, so that what came once is rare.
    """

    topic: str
    depth: int
    size_bytes: int
    rate_hz: float


@dataclass(frozen=True)
class Input:
    """A subscription."""

    topic: str
    depth: int


@dataclass(frozen=True)
class Node:
    """A node by its full name."""

    name: str
    outputs: tuple[Output, ...]
    inputs: tuple[Input, ...]


@dataclass(frozen=True)
class Skeleton:
    """Nodes, which talk to each other."""

    nodes: tuple[Node, ...]

    @property
    def rate_hz(self) -> float:
        """Return the messages that are published per second."""
        return sum(output.rate_hz for node in self.nodes for output in node.outputs)

    @property
    def deliveries_hz(self) -> float:
        """Return the messages that are due to subscriptions per second."""
        readers = self._readers()
        return sum(one.rate_hz * readers[one.topic] for node in self.nodes for one in node.outputs)

    @property
    def bytes_per_s(self) -> float:
        """Return the bytes that are published per second."""
        return sum(one.rate_hz * one.size_bytes for node in self.nodes for one in node.outputs)

    def first(self, count: int) -> Skeleton:
        """Return the first nodes."""
        return Skeleton(self.nodes[:count])

    def arguments(self) -> list[dict[str, str]]:
        """Return the arguments of the program skeleton_node for each node."""
        readers = self._readers()
        writers = Counter(one.topic for node in self.nodes for one in node.outputs)
        return [
            {
                "name": node.name,
                "publishers": ",".join(_words(one, readers[one.topic]) for one in node.outputs),
                "subscriptions": ",".join(
                    f"{one.topic}:{one.depth}:{writers[one.topic]}" for one in node.inputs
                ),
            }
            for node in self.nodes
        ]

    def _readers(self) -> Counter[str]:
        return Counter(one.topic for node in self.nodes for one in node.inputs)


def _words(one: Output, readers: int) -> str:
    period_us = round(1e6 / one.rate_hz) if one.rate_hz else 0
    return f"{one.topic}:{one.depth}:{one.size_bytes}:{period_us}:{readers}"


def skeleton_of(profile: Profile) -> Skeleton:
    """Return the skeleton of a profile, without endpoints whose node is unknown."""
    return Skeleton(
        tuple(
            Node(
                node.name,
                tuple(
                    _output(one, profile.duration_ns)
                    for one in profile.publishers
                    if one.node == index and one.topic not in OF_EVERY_NODE
                ),
                tuple(
                    Input(one.topic, one.queue_depth or _DEFAULT_DEPTH)
                    for one in profile.subscriptions
                    if one.node == index and one.topic not in OF_EVERY_NODE
                ),
            )
            for index, node in enumerate(profile.nodes)
        )
    )


def _output(one: Publisher, duration_ns: int | None) -> Output:
    size = one.size_bytes
    return Output(
        one.topic,
        one.queue_depth or _DEFAULT_DEPTH,
        round(size.mean) if size else assumed_bytes(one.topic),
        _rate_hz(one, duration_ns),
    )


def _rate_hz(one: Publisher, duration_ns: int | None) -> float:
    if one.publications is not None and duration_ns:
        return 1e9 * one.publications / duration_ns
    return 1e9 / one.interval_ns.mean if one.interval_ns and one.interval_ns.mean else 0.0
