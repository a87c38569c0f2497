# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Latency of chains and of their parts, in microseconds."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from rmw_manycore_py.trace.chains import CausedMessages, Chain, Passage
from rmw_manycore_py.trace.matching import Matching

TOTAL = "total"  # part that is the sum of the others
_NS_PER_US = 1000
_Z_95 = 1.96


@dataclass(frozen=True)
class Part:
    """Samples of one part of a chain."""

    name: str
    samples_us: tuple[float, ...]

    def quantile(self, share: float) -> float:
        """Return a quantile of the samples."""
        return float(np.quantile(self.samples_us, share)) if self.samples_us else math.nan

    def median_interval(self) -> tuple[float, float]:
        """Return the 95 % confidence interval of the median, from order statistics."""
        ordered = sorted(self.samples_us)
        half = _Z_95 * math.sqrt(len(ordered)) / 2
        middle = len(ordered) / 2
        low = max(math.floor(middle - half), 0)
        high = min(math.ceil(middle + half), len(ordered) - 1)
        return ordered[low], ordered[high]

    def row(self) -> dict[str, Any]:
        """Return the JSON row; JSON has no NaN."""
        quantiles = {"p50_us": 0.5, "p99_us": 0.99, "max_us": 1}
        return {
            "part": self.name,
            "count": len(self.samples_us),
            **{
                name: self.quantile(share) if self.samples_us else None
                for name, share in quantiles.items()
            },
        }


@dataclass(frozen=True)
class ChainLatency:
    """Latency of a chain: each hop, their sum, and two end-to-end measures."""

    chain: Chain
    nodes: tuple[str, ...]
    parts: tuple[Part, ...]  # alternating communication and node with sub-parts; then the whole

    @property
    def name(self) -> str:
        """The topics, and the nodes that took them."""
        steps = zip(self.chain, self.nodes, strict=True)
        return " > ".join(f"{topic} ({node})" for topic, node in steps)

    def row(self) -> dict[str, Any]:
        """Return the JSON row."""
        return {
            "chain": list(self.chain),
            "nodes": list(self.nodes),
            "parts": [part.row() for part in self.parts],
        }


def latencies(messages: CausedMessages, chains: Sequence[Chain]) -> list[ChainLatency]:
    """Return the latency of each chain, one per path through nodes."""
    found = []
    for chain in chains:
        by_nodes: dict[tuple[str, ...], list[Passage]] = defaultdict(list)
        for passage in messages.passages(chain):
            by_nodes[passage.nodes].append(passage)
        found += [_latency(chain, nodes, by_nodes[nodes]) for nodes in sorted(by_nodes)]
    return found


def _latency(chain: Chain, nodes: tuple[str, ...], passages: list[Passage]) -> ChainLatency:
    ages = [p.age_ns for p in passages if p.age_ns is not None]
    parts = [_part(f"bridge in {chain[0]}", ages)] if len(ages) == len(passages) else []
    for i, topic in enumerate(chain):
        came = [p.callback_ns[i] - p.published_ns[i] for p in passages]
        parts.append(_part(f"communication {topic}", came))
        if i + 1 < len(chain):
            worked = [p.published_ns[i + 1] - p.callback_ns[i] for p in passages]
            parts.append(_part(f"node {nodes[i]}", worked))
            parts += _matching(nodes[i], [p.matching_ns[i] for p in passages])
    left = [p.bridged_ns - p.callback_ns[-1] for p in passages if p.bridged_ns is not None]
    if len(left) == len(passages):
        parts.append(_part(f"bridge out {chain[-1]}", left))
    parts.append(_part(TOTAL, [_total_ns(p) for p in passages]))
    parts.append(_part("reaction", _reactions_ns(passages)))
    parts.append(_part("data age", _ages_ns(passages)))
    return ChainLatency(chain, nodes, tuple(parts))


def _matching(node: str, matchings: Sequence[Matching | None]) -> list[Part]:
    """Return the shares of a node's time spent in scan matching."""
    known = [one for one in matchings if one is not None]
    if not known:
        return []
    return [
        _part(f"NDT alignment {node}", [one.alignment_ns for one in known]),
        _part(f"NDT workers {node}", [one.workers_ns for one in known]),
    ]


def _total_ns(passage: Passage) -> int:
    """Return the sum of communication, node and bridge."""
    end_ns = passage.callback_ns[-1] if passage.bridged_ns is None else passage.bridged_ns
    return end_ns - passage.published_ns[0] + (passage.age_ns or 0)


def _part(name: str, samples_ns: list[int]) -> Part:
    return Part(name, tuple(sample / _NS_PER_US for sample in samples_ns))


def _firsts(passages: list[Passage]) -> list[Passage]:
    """Return the first arrival per input, without inputs overtaken by newer ones."""
    found: list[Passage] = []
    for passage in passages:
        if not found or passage.published_ns[0] > found[-1].published_ns[0]:
            found.append(passage)
    return found


def _reactions_ns(passages: list[Passage]) -> list[int]:
    """Return the maximum times from an external change to the first callback that reflects it.

    In the worst case, the change happens just after an input was published and waits for the next
    input that arrives.
    """
    firsts = _firsts(passages)
    return _to_next(firsts)


def _ages_ns(passages: list[Passage]) -> list[int]:
    """Return the age of each input used by the last node, when a newer one arrives."""
    return _to_next(passages)


def _to_next(passages: list[Passage]) -> list[int]:
    """Return the time from each input to the arrival of the next one."""
    return [after.callback_ns[-1] - before.published_ns[0] for before, after in pairwise(passages)]
