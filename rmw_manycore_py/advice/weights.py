# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a mapping costs before it is simulated: integers, as the solver needs them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from rmw_manycore_py.advice.problem import Clusters, Problem

Objective = Literal["p99", "max", "jitter", "load", "bytes"]
OBJECTIVES: tuple[Objective, ...] = ("p99", "max", "jitter", "load", "bytes")
# Sum of the costs of a mapping in which every message crosses.
_WHOLE = 1_000_000
_LEAST = 1  # of a flow without messages: it is not torn apart without reason
_MOVE = 1  # of a unit: equal mappings leave it where it is


@dataclass(frozen=True)
class Emphasis:
    """Relative weights of messages, bytes, messages of the hot chain, and the fullest cluster."""

    name: str
    messages: float = 0.0
    bytes: float = 0.0
    hot: float = 0.0
    load: float = 0.0


_HOPS = Emphasis("fewest hops", messages=1, hot=10)
_BYTES = Emphasis("fewest bytes", bytes=10, messages=1)
_LOAD = Emphasis("even load", load=10, messages=1)
_HOPS_AND_LOAD = Emphasis("few hops at even load", messages=1, hot=10, load=2)
_HOPS_AND_BYTES = Emphasis("few hops and bytes", messages=1, hot=5, bytes=3, load=0.5)
_TIMES = (_HOPS_AND_LOAD, _HOPS, _HOPS_AND_BYTES, _LOAD)
EMPHASES: dict[Objective, tuple[Emphasis, ...]] = {
    "p99": _TIMES,
    "max": _TIMES,
    "jitter": _TIMES,
    "load": (_LOAD, _HOPS_AND_LOAD),
    "bytes": (_BYTES, _HOPS_AND_BYTES),
}


@dataclass(frozen=True)
class Weights:
    """Costs of what a mapping does.

    :param crossing: of each flow, for each other cluster that receives it.
    :param load: of each unit in the fullest cluster.
    """

    crossing: tuple[int, ...]
    load: tuple[int, ...]

    @classmethod
    def of(cls, problem: Problem, emphasis: Emphasis) -> Weights:
        """Return the weights of a problem."""
        flows = problem.flows
        messages = _shares([0 if one.is_hot else one.messages_per_s for one in flows])
        size = _shares([one.bytes_per_s for one in flows])
        hot = _shares([one.messages_per_s if one.is_hot else 0 for one in flows])
        crossing = tuple(
            _LEAST + round(emphasis.messages * a + emphasis.bytes * b + emphasis.hot * c)
            for a, b, c in zip(messages, size, hot, strict=True)
        )
        loads = _shares([unit.load_cpus for unit in problem.units])
        return cls(crossing, tuple(round(emphasis.load * share) for share in loads))

    def cost(self, problem: Problem, clusters: Clusters) -> int:
        """Return what a mapping costs."""
        crossing = sum(
            weight * len(flow.crossed(clusters))
            for weight, flow in zip(self.crossing, problem.flows, strict=True)
        )
        loads = dict.fromkeys(clusters, 0)
        for weight, cluster in zip(self.load, clusters, strict=True):
            loads[cluster] += weight
        moved = sum(a != b for a, b in zip(problem.now, clusters, strict=True))
        return crossing + max(loads.values(), default=0) + _MOVE * moved


def _shares(values: list[float]) -> list[float]:
    total = sum(values)
    return [value / total * _WHOLE if total else 0.0 for value in values]
