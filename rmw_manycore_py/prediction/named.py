# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Latency of chains that a profile names, in the terms of CARET.

A node's publication belongs to the latest message of the chain that it has taken before. Of several
outputs of one input the first counts (CARET's best case). A chain begins and ends with its first
and its last callback.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.profile.model import Chain, Hop, Profile

Times = NDArray[np.float64]
Numbers = NDArray[np.int64]


@dataclass(frozen=True)
class Published:
    """Publications of a publisher by number: when, and when their callbacks began."""

    times_ns: Times
    begins_ns: Times


@dataclass(frozen=True)
class Takes:
    """Messages that a subscription took, in order: begin and end of the callback, the record."""

    begins_ns: Times
    ends_ns: Times
    publishers: Numbers
    numbers: Numbers


@dataclass(frozen=True)
class Passed:
    """All messages of a run, real or simulated.

    :ivar published: by publisher; `node_of` has its node.
    :ivar taken: by node and topic.
    """

    published: Mapping[int, Published]
    node_of: Mapping[int, str]
    taken: Mapping[tuple[str, str], Takes]


def named_chains(profile: Profile, passed: Passed) -> Iterator[tuple[str, list[float]]]:
    """Yield the latencies in ns of each chain that the profile names."""
    names = [node.name for node in profile.nodes]
    for chain in profile.chains:
        yield chain.name, best_ns(chain, names, passed)


def best_ns(chain: Chain, names: list[str], passed: Passed) -> list[float]:
    """Return the latencies of a chain; none if a part of it is unknown."""
    *before, last = chain.hops
    takes = _takes(last, names, passed)
    if takes is None or not before:
        return []
    ends_ns, publishers, numbers = takes.ends_ns, takes.publishers, takes.numbers
    for hop in reversed(before):
        is_own = np.array(
            [passed.node_of.get(int(one)) == names[hop.node] for one in publishers], bool
        )
        ends_ns, publishers, numbers = ends_ns[is_own], publishers[is_own], numbers[is_own]
        if hop is before[0]:
            break
        came = _takes(hop, names, passed)
        if came is None or not len(ends_ns):
            return []
        at = np.searchsorted(came.begins_ns, _times(passed, publishers, numbers), "right") - 1
        known = at >= 0
        ends_ns, at = ends_ns[known], at[known]
        publishers, numbers = came.publishers[at], came.numbers[at]
    return _first_of_each(ends_ns, publishers, numbers, passed)


def _takes(hop: Hop, names: list[str], passed: Passed) -> Takes | None:
    return passed.taken.get((names[hop.node], hop.subscribes or ""))


def _times(passed: Passed, publishers: Numbers, numbers: Numbers) -> Times:
    pairs = zip(publishers.tolist(), numbers.tolist(), strict=True)
    return np.array([passed.published[one].times_ns[number] for one, number in pairs])


def _first_of_each(
    ends_ns: Times, publishers: Numbers, numbers: Numbers, passed: Passed
) -> list[float]:
    """Return the latency of the first output of each input."""
    first: dict[tuple[int, int], float] = {}
    for end_ns, publisher, number in zip(
        ends_ns.tolist(), publishers.tolist(), numbers.tolist(), strict=True
    ):
        key = (publisher, number)
        first[key] = min(end_ns, first.get(key, end_ns))
    return [
        end_ns - float(passed.published[publisher].begins_ns[number])
        for (publisher, number), end_ns in first.items()
    ]
