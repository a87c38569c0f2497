# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Facts about a placement: from the mapfile and the sources, and at the rates of a trace."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rmw_manycore_py.mapfile import ClusterMemory, Placement
from rmw_manycore_py.mapfile.mapping.crossing import Crossing, Publication, Traffic
from rmw_manycore_py.mapfile.mapping.places import Places
from rmw_manycore_py.mapfile.mapping.rates import Rates, TracedFacts
from rmw_manycore_py.mapfile.mapping.recorded import Recorded
from rmw_manycore_py.platform.monitor.graph import EVERY_NODES_TOPICS
from rmw_manycore_py.trace.events import Trace


@dataclass(frozen=True)
class Facts:
    """Facts about a placement.

    :param memory: of each cluster, when the nodes have started.
    :param topics: names of the known topics.
    :param crossings: those of them that cross clusters; without a trace, of 0 messages.
    :param unknown: nodes whose topics neither mapfile, nor sources, nor trace tell.
    :param traced: loads, and what else a trace has; None without one.
    """

    memory: tuple[ClusterMemory, ...]
    topics: frozenset[str]
    crossings: tuple[Crossing, ...]
    unknown: tuple[str, ...]
    traced: TracedFacts | None = None

    @property
    def crossing_topics(self) -> frozenset[str]:
        """Names of the topics that cross clusters."""
        return frozenset(one.topic for one in self.crossings)

    @property
    def growing(self) -> Mapping[str, int]:
        """Topics whose size the memory does not have, with the largest message of the trace."""
        largest = self.traced.largest if self.traced else {}
        names = {topic for one in self.memory for topic in one.growing}
        return {topic: largest.get(topic, 0) for topic in sorted(names)}

    def per_s(self, amount: float) -> float | None:
        """Return a rate of the trace."""
        return self.traced.recorded.per_s(amount) if self.traced else None


def facts_of(placement: Placement, trace: Trace | None = None) -> Facts:
    """Return the facts about a placement, at the rates of a trace.

    :raises ManycoreError: if the trace has no message, or none of the nodes.
    """
    places = Places(placement)
    rates = Rates(Recorded.of(trace), places) if trace else None
    publications, subscriptions = [*places.publications()], [*places.subscriptions()]
    if rates is None:
        publications += [Publication(*one) for one in places.bridged("inward")]
        subscriptions += places.bridged("outward")
    else:
        publications += rates.publications()
        subscriptions += rates.subscriptions()
    crossings = tuple(Traffic.of(publications, subscriptions).crossings())
    known = {topic.name for topic in placement.topics}
    if rates is not None:
        known |= {one.topic for one in publications} | {topic for topic, _ in subscriptions}
    unknown = [node.full_name for node in placement.nodes if node.has_unknown_topics]
    return Facts(
        memory=placement.memory,
        topics=frozenset(known - EVERY_NODES_TOPICS | {one.topic for one in crossings}),
        crossings=crossings,
        unknown=tuple(name for name in unknown if rates is None or name not in rates.nodes),
        traced=rates.facts(crossings) if rates else None,
    )
