# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Compares the latency of two traces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

from rmw_manycore_py.trace.latency import ChainLatency, Part

Verdict = Literal["slower", "faster", "same", "too few"]
MIN_SAMPLES = 6  # with fewer, the confidence interval is unbounded


@dataclass(frozen=True)
class Change:
    """A part of a chain in both traces."""

    chain: str
    part: str
    before_us: float  # medians
    after_us: float
    verdict: Verdict

    def row(self) -> dict[str, Any]:
        """Return the JSON row."""
        return dict(vars(self))


def compare(before: Sequence[ChainLatency], after: Sequence[ChainLatency]) -> list[Change]:
    """Return the parts present in both; changed if the medians' intervals do not overlap."""
    known = {(one.chain, one.nodes): one for one in before}
    changes = []
    for one in after:
        other = known.get((one.chain, one.nodes))
        if other is not None:
            old_parts = {part.name: part for part in other.parts if part.samples_us}
            changes += [
                _change(one.name, old_parts[new.name], new)
                for new in one.parts
                if new.samples_us and new.name in old_parts
            ]
    return changes


def _change(chain: str, old: Part, new: Part) -> Change:
    return Change(chain, old.name, old.quantile(0.5), new.quantile(0.5), _verdict(old, new))


def _verdict(old: Part, new: Part) -> Verdict:
    if min(len(old.samples_us), len(new.samples_us)) < MIN_SAMPLES:
        return "too few"
    (old_low, old_high), (new_low, new_high) = old.median_interval(), new.median_interval()
    if new_low > old_high:
        return "slower"
    return "faster" if new_high < old_low else "same"
