# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rates and loads of a trace for nodes at other places."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.mapfile.mapping.crossing import Crossing, Publication
from rmw_manycore_py.mapfile.mapping.places import Places
from rmw_manycore_py.mapfile.mapping.recorded import Recorded
from rmw_manycore_py.platform.topology import Core


@dataclass(frozen=True)
class CoreLoad:
    """Load of a core, as a share of one CPU of the machine that was traced."""

    core: Core
    nodes: tuple[str, ...]
    cpu_share: float


@dataclass(frozen=True)
class ReceiveThreadLoad:
    """Load of a cluster's receive thread; its CPU share is unknown if the trace has no message."""

    cluster: int
    messages_per_s: float
    cpu_share: float | None


@dataclass(frozen=True)
class TracedFacts:
    """What a trace adds to the facts about a placement.

    :param recorded: its numbers.
    :param cores: their loads.
    :param receive_threads: their loads, of those that get a message.
    :param not_traced: nodes of the mapfile without a message in the trace.
    :param largest: bytes of the largest message, by topic.
    :param peak_smem_bytes: by cluster, if the nodes were in the same clusters as in the mapfile;
        else empty.
    """

    recorded: Recorded
    cores: tuple[CoreLoad, ...]
    receive_threads: tuple[ReceiveThreadLoad, ...]
    not_traced: tuple[str, ...]
    largest: Mapping[str, int]
    peak_smem_bytes: Mapping[int, int]


class Rates:
    """Numbers of a trace, its nodes being at the places of a mapfile."""

    def __init__(self, recorded: Recorded, places: Places) -> None:
        self._recorded = recorded
        self._places = places
        self._loads = tuple(recorded.loads())
        self.nodes = {name for load in self._loads for name in load.nodes} & set(places.cores)
        if not self.nodes:
            raise ManycoreError(
                "the trace has none of the mapfile's nodes: record one with "
                "`manycore run MAPFILE --trace FILE`",
                EXIT_BAD_INPUT,
            )

    def publications(self) -> Iterator[Publication]:
        """Yield what was published."""
        for endpoint, count in self._recorded.publications.items():
            named = self._recorded.topic(endpoint)
            core = self._places.core(named.node) if named else None
            if named is not None and core is not None:
                yield Publication(named.topic, core.cluster, count.messages, count.size_bytes)

    def subscriptions(self) -> Iterator[tuple[str, int]]:
        """Yield topics, with clusters of the mapfile that receive them."""
        for named in self._recorded.subscriptions():
            core = self._places.core(named.node)
            if core is not None:
                yield named.topic, core.cluster

    def facts(self, crossings: Sequence[Crossing]) -> TracedFacts:
        """Return the loads with these crossings."""
        largest: dict[str, int] = {}
        for endpoint, count in self._recorded.publications.items():
            topic = self._recorded.trace.topic_of(endpoint)
            largest[topic] = max(count.largest_bytes, largest.get(topic, 0))
        return TracedFacts(
            recorded=self._recorded,
            cores=tuple(self._cores()),
            receive_threads=tuple(self._receive_threads(crossings)),
            not_traced=tuple(sorted(set(self._places.cores) - self.nodes)),
            largest=largest,
            peak_smem_bytes=self._recorded.peak_smem_bytes() if self._is_same() else {},
        )

    def _is_same(self) -> bool:
        """Return whether the nodes were in their clusters of the mapfile, each of them."""
        places = {name: load.process.cluster for load in self._loads for name in load.nodes}
        own = {name: core.cluster for name, core in self._places.cores.items()}
        return all(places.get(name) == cluster for name, cluster in own.items())

    def _cores(self) -> Iterator[CoreLoad]:
        """Yield the load of each core; a process of several nodes is where its first node is."""
        nodes: dict[Core, list[str]] = defaultdict(list)
        shares: dict[Core, float] = defaultdict(float)
        for load in self._loads:
            cores = {name: self._places.core(name) for name in load.nodes}
            core = next(filter(None, cores.values()), None)
            if core is not None:
                nodes[core] += [name for name in load.nodes if cores[name] is not None]
                shares[core] += load.cpu_share
        for core in sorted(nodes):
            yield CoreLoad(core, tuple(nodes[core]), shares[core])

    def _receive_threads(self, crossings: Sequence[Crossing]) -> Iterator[ReceiveThreadLoad]:
        cpu_s = self._recorded.receive_cpu_s()
        messages: Counter[int] = Counter()
        for one in crossings:
            messages[one.receiver_cluster] += one.messages
        for cluster, count in sorted(messages.items()):
            rate = self._recorded.per_s(count)
            yield ReceiveThreadLoad(cluster, rate, None if cpu_s is None else rate * cpu_s)
