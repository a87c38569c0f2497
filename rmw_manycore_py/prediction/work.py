# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a callback does in one execution: CPU time, and publications on the way.

A callback that publishes in some executions only does so in its longest ones. Callbacks of a node
that share a publisher, and publish about as often as the rarest of them runs, wait for each other:
the last one to have a new message publishes.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from rmw_manycore_py.prediction.draws import Floats, Quantiles
from rmw_manycore_py.profile.model import Callback, Distribution, Output, Profile

_BLOCK = 256
_ALIKE = 0.15  # of a count: publications of nodes that wait for all inputs

Execution = tuple[float, tuple[tuple[float, int], ...]]  # CPU time; offset and publisher of each


@dataclass(eq=False)
class Join:
    """Inputs of a node that publishes when it has a new message of each."""

    members: frozenset[int]
    fresh: set[int] = field(default_factory=set)

    def arrive(self, member: int) -> bool:
        """Take a message of an input; return whether it was the last one."""
        self.fresh.add(member)
        if self.fresh != self.members:
            return False
        self.fresh.clear()
        return True


def joins_of(profile: Profile) -> dict[int, Join]:
    """Return the joins by callback."""
    found: dict[int, Join] = {}
    for members in _sharing(profile).values():
        callbacks = [profile.callbacks[index] for index in members]
        counts = [_count_of(one) for one in callbacks]
        published = sum(_published(one) for one in callbacks)
        rarest = min(counts)
        if len(members) > 1 and rarest and abs(published - rarest) <= _ALIKE * rarest:
            join = Join(frozenset(members))
            found.update(dict.fromkeys(members, join))
    return found


def _sharing(profile: Profile) -> dict[int, list[int]]:
    """Return the subscriptions' callbacks that publish with each publisher."""
    found: dict[int, list[int]] = defaultdict(list)
    for index, callback in enumerate(profile.callbacks):
        if callback.kind == "subscription":
            for output in callback.publishes:
                if output.count:
                    found[output.publisher].append(index)
    return found


def _count_of(callback: Callback) -> int:
    return callback.executions or 0


def _published(callback: Callback) -> int:
    return max((one.count or 0 for one in callback.publishes), default=0)


def _share(callback: Callback, output: Output) -> float:
    """Return publications per execution; 1 if that is unknown."""
    if output.count is None or not callback.executions:
        return 1.0
    return output.count / callback.executions


class Demand:
    """Draws the executions of a callback.

    :param shares: publications per execution, by publisher, where the profile does not say.
    """

    def __init__(
        self,
        profile: Profile,
        callback: Callback,
        random: np.random.Generator,
        speed: float,
        shares: Mapping[int, float],
    ) -> None:
        points = np.array(profile.quantile_shares)
        times = callback.cpu_ns or callback.wall_ns
        assert times is not None
        self._random = random
        self._times = Quantiles(points, _scaled(times, speed))
        self._wall = Quantiles(points, callback.wall_ns or times)
        self._outputs = [
            (
                one.publisher,
                shares.get(one.publisher, _share(callback, one)),
                Quantiles(points, one.offset_ns) if one.offset_ns else None,
            )
            for one in callback.publishes
        ]
        self._rarest = min((share for _, share, _ in self._outputs), default=1.0)
        self.always_publishes = self._rarest >= 1.0
        self.next = self._endless(self._any)
        self.next_publishing = self._endless(self._publishing)
        self.next_silent = self._endless(self._silent)

    def _endless(self, make: Callable[[], Iterator[Execution]]) -> Callable[[], Execution]:
        def executions() -> Iterator[Execution]:
            while True:
                yield from make()

        return executions().__next__

    def _any(self) -> Iterator[Execution]:
        return self._executions(self._random.random(_BLOCK), None)

    def _publishing(self) -> Iterator[Execution]:
        low = max(1.0 - self._rarest, 0.0)
        return self._executions(low + (1.0 - low) * self._random.random(_BLOCK), 1)

    def _silent(self) -> Iterator[Execution]:
        high = max(1.0 - self._rarest, 0.0) or 1.0
        return self._executions(high * self._random.random(_BLOCK), 0)

    def _executions(self, ranks: Floats, wanted: int | None) -> Iterator[Execution]:
        """Yield executions at these ranks of the distribution, with `wanted` publications each."""
        demands = self._times.at(ranks)
        columns = [self._published(ranks, wanted, *output) for output in self._outputs]
        if not columns:
            yield from ((demand, ()) for demand in demands.tolist())
            return
        for row, demand in enumerate(demands.tolist()):
            published = [
                (demand * fractions[row], publisher)
                for publisher, counts, fractions in columns
                for _ in range(counts[row])
            ]
            published.sort()
            yield demand, tuple(published)

    def _published(
        self, ranks: Floats, wanted: int | None, publisher: int, share: float, at: Quantiles | None
    ) -> tuple[int, list[int], list[float]]:
        """Return how often each execution publishes, and at which part of its time."""
        whole = int(share)
        rest = share - whole
        if wanted is None:
            counts = whole + (ranks > 1.0 - rest).astype(int)
        else:
            counts = np.full(len(ranks), wanted)
        if at is None:
            return publisher, counts.tolist(), [1.0] * len(ranks)
        within = np.clip((ranks - 1.0) / min(share, 1.0) + 1.0, 0.0, 1.0)
        wall = np.maximum(self._wall.at(ranks), 1.0)
        fractions = np.clip(at.at(within) / wall, 0.0, 1.0)
        return publisher, counts.tolist(), fractions.tolist()


def _scaled(distribution: Distribution, speed: float) -> Distribution:
    values = tuple(value / speed for value in distribution.quantiles)
    return distribution.model_copy(update={"quantiles": values})
