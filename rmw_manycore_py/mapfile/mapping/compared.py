# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Traffic between clusters in two traces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from rmw_manycore_py.mapfile.mapping.recorded import Recorded
from rmw_manycore_py.trace.events import Trace

Verdict = Literal["more", "less", "same"]
_SAME = 0.01  # of the crossings per message: of runs that begin and end elsewhere in a period


@dataclass(frozen=True)
class ClusterTraffic:
    """Messages between the clusters of a trace.

    `published` counts messages with a subscription; `share` is the part of them that leave their
    cluster. A message to two other clusters counts twice in `messages`, and its bytes in `bytes`.
    """

    duration_s: float
    published: int
    messages: int
    bytes: int
    messages_per_s: float
    bytes_per_s: float
    share: float

    @classmethod
    def of(cls, trace: Trace) -> ClusterTraffic:
        """Count the messages of a trace; raise ManycoreError if nothing was published."""
        recorded = Recorded.of(trace)
        traffic = recorded.traffic()
        crossings = traffic.crossings()
        messages = sum(one.messages for one in crossings)
        size_bytes = sum(one.size_bytes for one in crossings)
        published = traffic.received_messages
        return cls(
            duration_s=recorded.seconds,
            published=published,
            messages=messages,
            bytes=size_bytes,
            messages_per_s=recorded.per_s(messages),
            bytes_per_s=recorded.per_s(size_bytes),
            share=traffic.leaving_messages / published if published else 0.0,
        )

    @property
    def per_message(self) -> float:
        """Crossings per published message, which do not depend on the speed of the machine."""
        return self.messages / self.published if self.published else 0.0


def verdict(before: ClusterTraffic, after: ClusterTraffic) -> Verdict:
    """Return whether a message crosses clusters more or less often."""
    change = after.per_message - before.per_message
    if abs(change) <= _SAME:
        return "same"
    return "more" if change > 0 else "less"


def row(before: ClusterTraffic, after: ClusterTraffic) -> dict[str, Any]:
    """Return the JSON row, beside those of chains."""
    return {
        "chain": None,
        "part": "between clusters",
        "before_us": None,
        "after_us": None,
        "verdict": verdict(before, after),
        "before": vars(before),
        "after": vars(after),
    }
