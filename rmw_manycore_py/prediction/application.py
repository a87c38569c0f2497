# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a profile has about the parts of a simulation: executors, callbacks and their demands."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from rmw_manycore_py.profile.model import Callback, Distribution, Profile

_ORDER = {"timer": 0, "subscription": 1, "service": 2, "client": 3, "unknown": 4}
_REENTRANT = "reentrant"


@dataclass(frozen=True)
class ExecutorPlan:
    """An executor: its callbacks by index, in the order in which it looks at them."""

    process: int
    threads: int
    callbacks: tuple[int, ...]


@dataclass(frozen=True)
class ProcessPlan:
    """A process: its nodes by index.

    :ivar rest_ns: CPU time after each callback; None if unknown.
    """

    label: str
    nodes: tuple[int, ...]
    rest_ns: float | None


@dataclass(frozen=True)
class Application:
    """A profile in the parts of a simulation.

    :ivar groups: the group of mutually exclusive callbacks that each callback is in.
    :ivar driven: callbacks whose messages are simulated; the others come at their intervals.
    """

    profile: Profile
    processes: tuple[ProcessPlan, ...]
    executors: tuple[ExecutorPlan, ...]
    groups: Mapping[int, int] = field(default_factory=dict)
    driven: frozenset[int] = frozenset()


def application_of(profile: Profile) -> Application:
    """Return the parts of a profile; callbacks that never ran are left out."""
    plan = _Plan(profile)
    executors = tuple(plan.executors())
    return Application(
        profile,
        tuple(plan.processes),
        executors,
        plan.groups(),
        frozenset(plan.driven()),
    )


class _Plan:
    def __init__(self, profile: Profile) -> None:
        self._profile = profile
        self._ran = [i for i, one in enumerate(profile.callbacks) if one.rate_hz and _time(one)]
        self._key_of_process: dict[object, int] = {}
        self.processes: list[ProcessPlan] = []
        nodes: dict[object, list[int]] = defaultdict(list)
        for index, node in enumerate(profile.nodes):
            nodes[index if node.process is None else ("process", node.process)].append(index)
        for key, own in nodes.items():
            self._key_of_process[key] = len(self.processes)
            process = profile.nodes[own[0]].process
            rest_ns = None if process is None else profile.processes[process].rest_ns
            self.processes.append(ProcessPlan(self._label(own), tuple(own), rest_ns))

    def _label(self, nodes: list[int]) -> str:
        first = self._profile.nodes[nodes[0]]
        if first.process is not None:
            return self._profile.processes[first.process].name
        return first.name.rpartition("/")[2]

    def _process_of(self, callback: Callback) -> int | None:
        """Return the process of a callback; None for one whose node is not known."""
        if callback.process is not None:
            found = self._key_of_process.get(("process", callback.process))
            if found is not None:
                return found
        if callback.node is None:
            return None
        process = self._profile.nodes[callback.node].process
        key = callback.node if process is None else ("process", process)
        return self._key_of_process[key]

    def executors(self) -> Iterator[ExecutorPlan]:
        """Yield the executors: those that the profile names, or else threads that share work."""
        by_executor: dict[tuple[int, object], list[int]] = defaultdict(list)
        for process, own in self._by_process().items():
            for index in own:
                by_executor[process, self._named_executor(index)].append(index)
        for (process, name), own in by_executor.items():
            if isinstance(name, int):
                kind = self._profile.executors[name].kind
                threads = len(own) if kind.startswith("multi") else 1
                yield self._executor(process, threads, own)
                continue
            for threads, shared in self._by_threads(own):
                yield self._executor(process, threads, shared)

    def _executor(self, process: int, threads: int, callbacks: list[int]) -> ExecutorPlan:
        ordered = sorted(callbacks, key=self._place_in_wait)
        return ExecutorPlan(process, max(threads, 1), tuple(ordered))

    def _place_in_wait(self, index: int) -> tuple[int, int, int]:
        """Return a sort key: subscriptions in the order of their creation."""
        callback = self._profile.callbacks[index]
        return _ORDER[callback.kind], callback.subscription or 0, index

    def _by_process(self) -> dict[int, list[int]]:
        found: dict[int, list[int]] = defaultdict(list)
        for index in self._ran:
            process = self._process_of(self._profile.callbacks[index])
            if process is not None:
                found[process].append(index)
        return found

    def _named_executor(self, index: int) -> int | None:
        group = self._profile.callbacks[index].group
        return None if group is None else self._profile.groups[group].executor

    def _by_threads(self, callbacks: list[int]) -> Iterator[tuple[int, list[int]]]:
        """Yield callbacks that ran on common threads, with the number of these."""
        parts: list[tuple[set[int], list[int]]] = []
        for index in callbacks:
            threads = set(self._profile.callbacks[index].threads)
            merged: tuple[set[int], list[int]] = (threads, [index])
            rest = []
            for part in parts:
                if part[0] & threads or not (part[0] or threads):
                    merged = (merged[0] | part[0], part[1] + merged[1])
                else:
                    rest.append(part)
            parts = [*rest, merged]
        for threads, own in parts:
            yield len(threads), own

    def groups(self) -> dict[int, int]:
        """Return the group of each callback, by default that of its node.

        Callbacks of a reentrant group are not in the result.
        """
        found: dict[int, int] = {}
        first_of_nodes = len(self._profile.groups)
        for index in self._ran:
            callback = self._profile.callbacks[index]
            if callback.group is not None:
                if self._profile.groups[callback.group].kind != _REENTRANT:
                    found[index] = callback.group
            elif callback.node is not None:
                found[index] = first_of_nodes + callback.node
        return found

    def driven(self) -> Iterator[int]:
        """Yield the callbacks of topics that something in the simulation publishes."""
        publishers = self._profile.publishers
        ran = set(self._ran)
        published = {
            publishers[output.publisher].topic
            for index in ran
            for output in self._profile.callbacks[index].publishes
        }
        published |= {one.topic for one in publishers if one.outside_callbacks}
        for index in ran:
            callback = self._profile.callbacks[index]
            if callback.kind == "subscription" and callback.trigger in published:
                yield index


def _time(callback: Callback) -> Distribution | None:
    return callback.cpu_ns or callback.wall_ns


def period_of(callback: Callback) -> float | None:
    """Return the period of a timer in ns; the mean interval if the profile lacks it."""
    if callback.period_ns is None:
        return callback.interval_ns.mean if callback.interval_ns else None
    return float(callback.period_ns)
