# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a simulated run comes to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from rmw_manycore_py.platform.topology import Core
from rmw_manycore_py.prediction.network import Link
from rmw_manycore_py.prediction.target import Target
from rmw_manycore_py.trace.events import Trace


@dataclass(frozen=True)
class ChainTimes:
    """Latency of a chain; times in us of the target.

    :ivar samples_us: of each message that went through, first to last.
    """

    name: str
    samples_us: tuple[float, ...]

    def quantile_us(self, share: float) -> float | None:
        """Return a quantile; None if no message went through."""
        return float(np.quantile(self.samples_us, share)) if self.samples_us else None

    def late(self, deadline_ms: float) -> int:
        """Return the number of messages that took longer."""
        return sum(one > deadline_ms * 1e3 for one in self.samples_us)

    def row(self) -> dict[str, Any]:
        """Return the JSON row."""
        names = {"p50_us": 0.5, "p99_us": 0.99, "max_us": 1.0}
        quantiles = {name: self.quantile_us(share) for name, share in names.items()}
        return {"chain": self.name, "count": len(self.samples_us), **quantiles}


@dataclass(frozen=True)
class CoreUse:
    """Load of a core with the nodes on it, as a share of its CPU."""

    core: Core
    nodes: tuple[str, ...]
    cpu_share: float


@dataclass(frozen=True)
class CpuUse:
    """Load of a host CPU, which cores and receive threads share."""

    cpu: int
    cpu_share: float


@dataclass(frozen=True)
class ReceiveThreadUse:
    """Load of a cluster's receive thread."""

    cluster: int
    messages_per_s: float
    cpu_share: float


@dataclass(frozen=True)
class QueueUse:
    """A subscriber queue that was full at least once, or lost messages."""

    node: str
    topic: str
    depth: int
    longest: int
    lost: int


@dataclass(frozen=True)
class Communication:
    """Times from the call of publish to the begin of a subscription's callback, in us.

    :ivar age_us: likewise, from the first publication of the chain; the median.
    """

    node: str
    topic: str
    count: int
    p50_us: float
    p99_us: float
    age_us: float


@dataclass(frozen=True)
class LinkUse:
    """Traffic on a link between clusters; its share of the time that it was occupied."""

    link: Link
    bytes_per_s: float
    share: float


@dataclass(frozen=True)
class TimerUse:
    """A timer that skipped due times."""

    node: str
    period_us: float
    missed: int


@dataclass(frozen=True)
class Prediction:
    """A simulated run.

    :ivar cpus: those of a `host`; empty where each core is a CPU.
    :ivar smem_bytes: peak by cluster: what nodes take, and what is held in topic DSMs.
    :ivar overwritten: messages that a full topic DSM lost before they were read, by topic.
    :ivar trace: events as of a real run; None unless asked for.
    :ivar executions: callbacks that ran.
    """

    target: Target
    duration_s: float
    chains: tuple[ChainTimes, ...]
    cores: tuple[CoreUse, ...]
    cpus: tuple[CpuUse, ...]
    receive_threads: tuple[ReceiveThreadUse, ...]
    smem_bytes: Mapping[int, int]
    communications: tuple[Communication, ...]
    links: tuple[LinkUse, ...]
    queues: tuple[QueueUse, ...]
    overwritten: Mapping[str, int]
    timers: tuple[TimerUse, ...]
    executions: int
    trace: Trace | None

    @property
    def busiest(self) -> float:
        """Load of the busiest CPU."""
        return max([one.cpu_share for one in self.cpus or self.cores], default=0.0)

    @property
    def lost(self) -> int:
        """Messages lost in queues."""
        return sum(one.lost for one in self.queues)
