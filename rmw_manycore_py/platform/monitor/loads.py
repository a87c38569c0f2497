# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rates on a platform: differences of two samples."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.platform.copies import copies_per_message
from rmw_manycore_py.platform.monitor.graph import Graph
from rmw_manycore_py.platform.monitor.sample import (
    BYTES,
    CAPACITY,
    EXPIRED,
    HELD_BYTES,
    IN_PLACE,
    LOST,
    MESSAGES,
    QUEUED,
    REFUSED,
    SUPERSEDED,
    Counts,
    Sample,
    aligned,
)

Rates = NDArray[np.float64]


class TopicLoad(NamedTuple):
    """Load of one topic."""

    rate_hz: float
    bytes_per_s: float
    queued: int  # in the fullest queue
    capacity: int  # of that queue
    lost: int  # missed by its current subscriptions, or refused
    superseded: int  # replaced by a newer one for its current subscriptions
    losses_per_s: float

    @property
    def message_bytes(self) -> float:
        """Mean size of a message in bytes."""
        return self.bytes_per_s / self.rate_hz if self.rate_hz else 0.0

    @property
    def fill(self) -> float:
        """Fill level of the fullest queue, 0..1."""
        return self.queued / self.capacity if self.capacity else 0.0


@dataclass(frozen=True)
class Loads:
    """Two samples, the older first; their graphs may differ."""

    before: Sample
    after: Sample

    @property
    def graph(self) -> Graph:
        """Graph of the newer sample."""
        return self.after.graph

    @property
    def seconds(self) -> float:
        """Time between the samples."""
        return self.after.time_s - self.before.time_s

    @cached_property
    def changes(self) -> Counts:
        """Increase of each counter of each endpoint; from zero for new endpoints."""
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
        """Publish rate of each topic in messages per second."""
        return self._per_s(MESSAGES, publishers=True)

    @cached_property
    def bytes_per_s(self) -> Rates:
        """Publish rate of each topic in bytes per second."""
        return self._per_s(BYTES, publishers=True)

    @cached_property
    def losses_per_s(self) -> Rates:
        """Messages per second missed by subscriptions or refused to publishers, per topic."""
        missed = self._per_s(LOST, publishers=False) + self._per_s(EXPIRED, publishers=False)
        result: Rates = missed + self._per_s(REFUSED, publishers=True)
        return result

    @cached_property
    def fullest(self) -> tuple[Counts, Counts]:
        """Entries and capacity of each topic's fullest queue.

        A queue for one message is full whenever there is one, so it shows nothing.
        """
        counts = self.after.counts
        rows = np.flatnonzero(~self.graph.is_publisher & (counts[:, CAPACITY] > 1))
        fill = counts[rows, QUEUED] / counts[rows, CAPACITY]
        rows = rows[np.argsort(fill, kind="stable")]  # the last of several assignments takes effect
        topics = self.graph.topic_index[rows]
        queued = np.zeros(len(self.graph.topics) + 1, dtype=np.int64)
        capacity = np.zeros_like(queued)
        queued[topics] = counts[rows, QUEUED]
        capacity[topics] = counts[rows, CAPACITY]
        return queued[:-1], capacity[:-1]

    @cached_property
    def lost(self) -> Counts:
        """Messages lost on each topic by its current endpoints."""
        after = self.after
        missed = after.totals(LOST, publishers=False) + after.totals(EXPIRED, publishers=False)
        result: Counts = missed + after.totals(REFUSED, publishers=True)
        return result

    def copies_of(self, row: int) -> float | None:
        """Return the copies of a message that an endpoint makes; None of small ones."""
        changes = self.changes[row]
        return copies_per_message(
            int(changes[MESSAGES]), int(changes[BYTES]), int(changes[IN_PLACE])
        )

    @cached_property
    def copies(self) -> dict[str, float]:
        """Copies of a message on its way to one subscription, of topics with large messages."""
        sides = (self._copies(publishers=True), self._copies(publishers=False))
        return {
            name: published + taken
            for name, published, taken in zip(self.graph.topics, *sides, strict=True)
            if published is not None and taken is not None
        }

    def _copies(self, *, publishers: bool) -> list[float | None]:
        chosen = self.graph.is_publisher == publishers
        sums = np.zeros((len(self.graph.topics) + 1, 3), dtype=np.int64)
        changes = self.changes[chosen][:, (MESSAGES, BYTES, IN_PLACE)]
        np.add.at(sums, self.graph.topic_index[chosen], changes)
        return [copies_per_message(*row) for row in sums[:-1].tolist()]

    @cached_property
    def held_bytes(self) -> dict[str, int]:
        """SMEM of large messages that readers hold, of the topics that have any."""
        held = self.after.totals(HELD_BYTES, publishers=True).tolist()
        return {name: size for name, size in zip(self.graph.topics, held, strict=True) if size}

    @cached_property
    def topics(self) -> dict[str, TopicLoad]:
        """Load of each topic."""
        return self._topics(self.rates_hz, self.bytes_per_s)

    @cached_property
    def rounded_topics(self) -> dict[str, TopicLoad]:
        """Load of each topic, as exact as it is displayed: equal where nothing else is shown."""
        rates_hz = _as_displayed(self.rates_hz)
        message_bytes = np.rint(self.bytes_per_s / np.where(self.rates_hz > 0, self.rates_hz, 1.0))
        return self._topics(rates_hz, message_bytes * rates_hz)

    def _topics(self, rates_hz: Rates, bytes_per_s: Rates) -> dict[str, TopicLoad]:
        queued, capacity = self.fullest
        superseded = self.after.totals(SUPERSEDED, publishers=False)
        columns = (
            *(rates_hz, bytes_per_s, queued, capacity),
            *(self.lost, superseded, self.losses_per_s),
        )
        rows = zip(*(column.tolist() for column in columns), strict=True)
        return dict(zip(self.graph.topics, map(TopicLoad._make, rows), strict=True))

    def cpu_share(self, pid: int) -> float:
        """Return the CPU usage of a process; 1.0 is one full CPU."""
        return self._cpu_shares.get(pid, 0.0)

    @cached_property
    def _cpu_shares(self) -> dict[int, float]:
        """By pid, of the processes that are in both samples."""
        if self.seconds <= 0:
            return {}
        then_ns, window_ns = self.before.cpu_ns, self.seconds * 1e9
        return {
            pid: max(now_ns - then_ns[pid], 0) / window_ns
            for pid, now_ns in self.after.cpu_ns.items()
            if pid in then_ns
        }

    def receive_thread_rates_hz(self) -> dict[int, float]:
        """Return the eMCOS messages per second of each cluster's receive thread."""
        earlier = {cluster.id: cluster.messages for cluster in self.before.clusters}
        return {
            cluster.id: max(cluster.messages - earlier.get(cluster.id, 0), 0) / self.seconds
            if self.seconds > 0
            else 0.0
            for cluster in self.after.clusters
        }


def _as_displayed(values: Rates) -> Rates:
    """Round to two significant digits below 100, to whole numbers from there on."""
    scale = 10.0 ** np.floor(np.log10(np.where(values > 0, values, 1.0)))
    result: Rates = np.where(values >= 100, np.rint(values), np.round(values / scale, 1) * scale)
    return result
