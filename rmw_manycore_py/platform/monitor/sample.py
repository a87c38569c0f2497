# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""All counters of a platform at one time."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.native import _transport
from rmw_manycore_py.platform.monitor.cpu_clocks import cpu_times_ns
from rmw_manycore_py.platform.monitor.graph import Graph

Counts = NDArray[np.int64]

# Columns of an activity row, after the endpoint.
(
    MESSAGES,
    BYTES,
    LOST,
    SUPERSEDED,
    EXPIRED,
    REFUSED,
    OVERWRITTEN,
    DROPPED,
    IN_PLACE,
    QUEUED,
    CAPACITY,
    DEADLINES,
    HELD_BYTES,
) = range(13)
_WORDS = 14


class ClusterCounters(Protocol):
    """Counters of a cluster, read from a platform or a trace."""

    @property
    def id(self) -> int:
        """Counted from 1."""

    @property
    def smem_bytes(self) -> int:
        """Size of its SMEM; 0 if unknown."""

    @property
    def used_bytes(self) -> int:
        """Bytes of its SMEM in use."""

    @property
    def alive(self) -> bool:
        """Whether its receive thread runs."""

    @property
    def receive_thread_pid(self) -> int:
        """Process of its receive thread."""

    @property
    def messages(self) -> int:
        """EMCOS messages that its receive thread has handled."""


@dataclass(frozen=True)
class Sample:
    """Counters of a platform; loads are differences of two samples."""

    time_s: float  # CLOCK_MONOTONIC
    graph: Graph
    clusters: tuple[ClusterCounters, ...]
    counts: Counts  # rows as in graph.endpoints, columns as above
    cpu_ns: dict[int, int]  # by pid: members, receive threads, workers

    def totals(self, column: int, *, publishers: bool) -> Counts:
        """Return a column's sum per topic, over publishers or subscriptions."""
        chosen = self.graph.is_publisher == publishers
        sums = np.zeros(len(self.graph.topics) + 1, dtype=np.int64)
        np.add.at(sums, self.graph.topic_index[chosen], self.counts[chosen, column])
        return sums[:-1]


def take_sample(
    platform: _transport.Platform, graph: Graph, workers: dict[int, tuple[int, ...]]
) -> Sample:
    """Read the counters of a platform with a known graph."""
    clusters = tuple(platform.clusters())
    pids = {member.pid for member in graph.members}
    pids.update(c.receive_thread_pid for c in clusters if c.alive and c.receive_thread_pid)
    pids.update(pid for group in workers.values() for pid in group)
    rows = np.frombuffer(platform.activity(), dtype=np.uint64).reshape(-1, _WORDS)
    counts = aligned(graph.ids, rows[:, 0], rows[:, 1:].astype(np.int64))
    return Sample(time.monotonic(), graph, clusters, counts, cpu_times_ns(pids))


def aligned(ids: NDArray[np.uint64], known: NDArray[np.uint64], counts: Counts) -> Counts:
    """Return the rows of `counts` (ordered as `known`) in the order of `ids`; zeros if missing."""
    result = np.zeros((len(ids), counts.shape[1]), dtype=np.int64)
    if len(known) == len(ids) and np.array_equal(known, ids):
        return counts
    if len(known) == 0 or len(ids) == 0:
        return result
    order = np.argsort(known)
    place = np.minimum(np.searchsorted(known, ids, sorter=order), len(known) - 1)
    rows = order[place]
    found = known[rows] == ids
    result[found] = counts[rows[found]]
    return result
