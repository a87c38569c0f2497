# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What moves on a platform: differences of two samples."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.look.graph import Graph
from rmw_manycore_py.look.sample import (
    BYTES,
    CAPACITY,
    EXPIRED,
    LOST,
    MESSAGES,
    QUEUED,
    REFUSED,
    Counts,
    Sample,
    aligned,
)

Rates = NDArray[np.float64]


@dataclass(frozen=True)
class TopicLoad:
    """What one topic carries."""

    rate_hz: float
    bytes_per_s: float
    queued: int  # in the fullest queue
    capacity: int  # of that queue
    lost: int  # not taken by its subscriptions, or refused, since they exist
    losses_per_s: float

    @property
    def message_bytes(self) -> float:
        """Mean size of a message."""
        return self.bytes_per_s / self.rate_hz if self.rate_hz else 0.0

    @property
    def fill(self) -> float:
        """Share of the fullest queue that is in use."""
        return self.queued / self.capacity if self.capacity else 0.0


@dataclass(frozen=True)
class Loads:
    """Two samples, the older one first; their graphs may differ."""

    before: Sample
    after: Sample

    @property
    def graph(self) -> Graph:
        """The graph of the later sample."""
        return self.after.graph

    @property
    def seconds(self) -> float:
        """Time between the two."""
        return self.after.time_s - self.before.time_s

    @cached_property
    def changes(self) -> Counts:
        """Growth of each counter of each endpoint; from zero where the endpoint is new."""
        before, after = self.before, self.after
        return after.counts - aligned(after.graph.ids, before.graph.ids, before.counts)

    def _per_s(self, column: int, *, publishers: bool) -> Rates:
        chosen = self.graph.is_publisher == publishers
        sums = np.bincount(
            self.graph.topic_index[chosen],
            weights=self.changes[chosen, column],
            minlength=len(self.graph.topics) + 1,
        )[:-1]
        result: Rates = np.maximum(sums, 0.0)
        return result / self.seconds if self.seconds > 0 else 0.0 * result

    @cached_property
    def rates_hz(self) -> Rates:
        """Messages per second that each topic's publishers publish."""
        return self._per_s(MESSAGES, publishers=True)

    @cached_property
    def bytes_per_s(self) -> Rates:
        """Bytes per second that each topic's publishers publish."""
        return self._per_s(BYTES, publishers=True)

    @cached_property
    def losses_per_s(self) -> Rates:
        """Messages per second that a subscription missed or a publisher could not send."""
        missed = self._per_s(LOST, publishers=False) + self._per_s(EXPIRED, publishers=False)
        result: Rates = missed + self._per_s(REFUSED, publishers=True)
        return result

    @cached_property
    def fullest(self) -> tuple[Counts, Counts]:
        """Entries and capacity of each topic's fullest queue."""
        counts = self.after.counts
        rows = np.flatnonzero(~self.graph.is_publisher & (counts[:, CAPACITY] > 0))
        fill = counts[rows, QUEUED] / counts[rows, CAPACITY]
        rows = rows[np.argsort(fill, kind="stable")]  # of several assignments the last one stays
        topics = self.graph.topic_index[rows]
        queued = np.zeros(len(self.graph.topics) + 1, dtype=np.int64)
        capacity = np.zeros_like(queued)
        queued[topics] = counts[rows, QUEUED]
        capacity[topics] = counts[rows, CAPACITY]
        return queued[:-1], capacity[:-1]

    @cached_property
    def lost(self) -> Counts:
        """Messages that did not arrive on each topic, since its endpoints exist."""
        after = self.after
        missed = after.totals(LOST, publishers=False) + after.totals(EXPIRED, publishers=False)
        result: Counts = missed + after.totals(REFUSED, publishers=True)
        return result

    @cached_property
    def topics(self) -> dict[str, TopicLoad]:
        """The load of each topic."""
        queued, capacity = self.fullest
        columns = (self.rates_hz, self.bytes_per_s, queued, capacity, self.lost, self.losses_per_s)
        rows = zip(*(column.tolist() for column in columns), strict=True)
        return {name: TopicLoad(*row) for name, row in zip(self.graph.topics, rows, strict=True)}

    def cpu_share(self, pid: int) -> float:
        """Return the share of a CPU that a process has used: 1.0 is all of one."""
        now = self.after.cpu_ns.get(pid)
        then = self.before.cpu_ns.get(pid)
        if now is None or then is None or self.seconds <= 0:
            return 0.0
        return max(now - then, 0) / 1e9 / self.seconds

    def receive_thread_rates_hz(self) -> dict[int, float]:
        """Return the eMCOS messages per second of each cluster's receive thread."""
        earlier = {cluster.id: cluster.messages for cluster in self.before.clusters}
        return {
            cluster.id: max(cluster.messages - earlier.get(cluster.id, 0), 0) / self.seconds
            if self.seconds > 0
            else 0.0
            for cluster in self.after.clusters
        }
