# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Topics that cross clusters.

A message crosses once to each other cluster with a subscription of its topic, as the eMCOS message
about it does; how many subscriptions are there, and when they take it, does not matter.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Publication:
    """What a node publishes on a topic, or that it does, where no trace has the numbers."""

    topic: str
    cluster: int
    messages: int = 0
    size_bytes: int = 0


@dataclass(frozen=True)
class Crossing:
    """Messages of a topic from one cluster to another."""

    topic: str
    publisher_cluster: int
    receiver_cluster: int
    messages: int
    size_bytes: int


@dataclass(frozen=True)
class Traffic:
    """Publications, and the clusters that receive each topic."""

    publications: tuple[Publication, ...]
    receivers: Mapping[str, frozenset[int]]

    @classmethod
    def of(
        cls, publications: Iterable[Publication], subscriptions: Iterable[tuple[str, int]]
    ) -> Traffic:
        """Return the traffic of publications and subscriptions, these as topic and cluster."""
        receivers: dict[str, set[int]] = defaultdict(set)
        for topic, cluster in subscriptions:
            receivers[topic].add(cluster)
        clusters = {topic: frozenset(found) for topic, found in receivers.items()}
        return cls(tuple(publications), clusters)

    def crossings(self) -> list[Crossing]:
        """Return the crossings by topic and clusters, those with most bytes first."""
        messages: Counter[tuple[str, int, int]] = Counter()
        sizes: Counter[tuple[str, int, int]] = Counter()
        for one in self.publications:
            for receiver in self._others(one):
                key = (one.topic, one.cluster, receiver)
                messages[key] += one.messages
                sizes[key] += one.size_bytes
        found = [Crossing(*key, messages[key], sizes[key]) for key in messages]
        return sorted(
            found,
            key=lambda one: (
                -one.size_bytes,
                one.topic,
                one.publisher_cluster,
                one.receiver_cluster,
            ),
        )

    @property
    def received_messages(self) -> int:
        """Messages published on topics with a subscription."""
        return sum(one.messages for one in self.publications if self.receivers.get(one.topic))

    @property
    def leaving_messages(self) -> int:
        """Those of them that cross to at least one cluster."""
        return sum(one.messages for one in self.publications if self._others(one))

    def _others(self, publication: Publication) -> frozenset[int]:
        return self.receivers.get(publication.topic, frozenset()) - {publication.cluster}
