# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The problem that mapfile and profile pose."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from rmw_manycore_py.advice.problem import Flow, Problem, Room, Unit
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.mapfile import BridgePlacement, Mapfile, PlacedNode, TopicEntry
from rmw_manycore_py.mapfile.placing.memory import Share, share_of_node
from rmw_manycore_py.mapfile.placing.topics import topic_table
from rmw_manycore_py.platform.monitor.graph import EVERY_NODES_TOPICS
from rmw_manycore_py.platform.smem import DEFAULT_DEPTH, Smem
from rmw_manycore_py.platform.texts import listed
from rmw_manycore_py.platform.topology import room_for_topic_dsms
from rmw_manycore_py.profile.model import Profile, Publisher
from rmw_manycore_py.ros.names import full_node_name

_BRIDGE = "/_manycore_bridge_"  # its nodes go on with the direction
_MAX_NAMES = 4


@dataclass
class Sent:
    """Rates of what a unit publishes on a topic."""

    messages_per_s: float = 0.0
    bytes_per_s: float = 0.0
    depth: int = DEFAULT_DEPTH


@dataclass
class Ends:
    """Ends of a topic, by unit."""

    publishers: dict[int, Sent] = field(default_factory=dict)
    receivers: set[int] = field(default_factory=set)


class Application:
    """Nodes of a mapfile, with their parts of a profile.

    :ivar not_profiled: nodes of the mapfile that the profile does not have.
    :ivar not_placed: nodes of the profile that the mapfile does not have.
    """

    def __init__(
        self,
        mapfile: Mapfile,
        nodes: Sequence[PlacedNode],
        bridge: BridgePlacement | None,
        profile: Profile,
    ) -> None:
        self._mapfile = mapfile
        self._nodes = nodes
        self._bridge = bridge
        self._profile = profile
        self._table = {one.name: one for one in topic_table(mapfile, nodes)}
        self._owners = dict(_owners(nodes))
        found = {one.name: self._unit(one.name) for one in profile.nodes}
        units = set(found.values())
        self.not_profiled = [one.full_name for i, one in enumerate(nodes) if i not in units]
        self.not_placed = [name for name, unit in found.items() if unit is None]
        if len(self.not_profiled) == len(nodes):
            expected = listed([node.full_name for node in nodes], _MAX_NAMES)
            names = listed([*found], _MAX_NAMES) or "no node"
            raise ManycoreError(
                f"the profile is of another application: expected {expected}, found {names}",
                EXIT_BAD_INPUT,
            )
        self.ends = self._all_ends()

    def problem(self, chain: Sequence[str] = ()) -> Problem:
        """Return the problem; `chain` are the topics of the chain that matters."""
        topology = self._mapfile.topology
        smem = Smem(topology.smem_size)
        units = [*self._units(smem)]
        if self._bridge is not None:
            cluster = self._bridge.core("inward", 0).cluster
            units.append(Unit("bridge", cluster, is_bridge=True))
        rooms = tuple(
            Room(one.id, one.free, room_for_topic_dsms(one.smem_size) - smem.head)
            for one in topology.clusters
        )
        flows = (*self._flows(smem), *self._hot_flows(chain))
        shares_cores = self._mapfile.sections.allow_shared_cores
        return Problem(tuple(units), rooms, flows, shares_cores=shares_cores)

    @property
    def has_sizes(self) -> bool:
        """Whether the profile knows how large messages are."""
        return any(one.size_bytes is not None for one in self._profile.publishers)

    def _unit(self, full_name: str) -> int | None:
        """Return the unit of a node; the bridge is behind the nodes."""
        if self._bridge is not None and full_name.startswith(_BRIDGE):
            return len(self._nodes)
        return self._owners.get(full_name)

    def _unit_of(self, node: int | None) -> int | None:
        return None if node is None else self._unit(self._profile.nodes[node].name)

    def _all_ends(self) -> dict[str, Ends]:
        """Return the ends of each topic, as mapfile, sources and profile know them."""
        ends: dict[str, Ends] = defaultdict(Ends)
        for unit, node in enumerate(self._nodes):
            for topic in node.publish:
                ends[topic].publishers[unit] = Sent(depth=node.depth("publish", topic))
            for topic in node.subscribe:
                ends[topic].receivers.add(unit)
        for route in self._bridge.routes if self._bridge else ():
            if route.kind == "topic" and not route.is_pattern:
                if route.direction == "inward":
                    ends[route.inside].publishers[len(self._nodes)] = Sent()
                else:
                    ends[route.inside].receivers.add(len(self._nodes))
        for index, one in enumerate(self._profile.publishers):
            publisher = self._unit_of(one.node)
            if publisher is None:
                continue
            sent = ends[one.topic].publishers.setdefault(publisher, Sent())
            rate = self._rate_hz(index, one)
            sent.messages_per_s += rate
            sent.bytes_per_s += rate * (one.size_bytes.mean if one.size_bytes else 0.0)
            sent.depth = one.queue_depth or sent.depth
        for subscription in self._profile.subscriptions:
            receiver = self._unit_of(subscription.node)
            if receiver is not None:
                ends[subscription.topic].receivers.add(receiver)
        return {name: one for name, one in ends.items() if name not in EVERY_NODES_TOPICS}

    def _rate_hz(self, index: int, one: Publisher) -> float:
        """Return how often it publishes: by counts, or as often as callbacks run that do."""
        if one.publications is not None and self._profile.duration_ns:
            return one.publications * 1e9 / self._profile.duration_ns
        return sum(
            callback.rate_hz or 0.0
            for callback in self._profile.callbacks
            if any(output.publisher == index for output in callback.publishes)
        )

    def _units(self, smem: Smem) -> Iterator[Unit]:
        loads: dict[int | None, float] = defaultdict(float)
        for callback in self._profile.callbacks:
            loads[self._unit_of(callback.node)] += callback.load_cpus
        for unit, node in enumerate(self._nodes):
            section = self._mapfile.sections.nodes[node.name]
            yield Unit(
                node.name,
                node.cluster,
                section.core,
                loads[unit],
                self._share(smem, unit, node).total,
                section.workers,
            )

    def _share(self, smem: Smem, unit: int, node: PlacedNode) -> Share:
        """Return the memory of a node, with endpoints that only the profile knows."""
        share = share_of_node(smem, node, self._table)
        for topic, ends in self.ends.items():
            if unit in ends.publishers and topic not in node.publish:
                depth = ends.publishers[unit].depth
                share.add_publisher(smem, topic, depth, self._table.get(topic))
        for one in self._profile.subscriptions:
            is_new = one.topic not in EVERY_NODES_TOPICS and one.topic not in node.subscribe
            if is_new and self._unit_of(one.node) == unit:
                share.queues += smem.subscription(one.queue_depth or DEFAULT_DEPTH)
        return share

    def _flows(self, smem: Smem) -> Iterator[Flow]:
        for topic, ends in sorted(self.ends.items()):
            entry = self._table.get(topic)
            for publisher, sent in sorted(ends.publishers.items()):
                receivers = frozenset(ends.receivers - {publisher})
                if receivers:
                    yield Flow(
                        topic,
                        publisher,
                        receivers,
                        sent.messages_per_s,
                        sent.bytes_per_s,
                        _landing_bytes(smem, entry, sent.depth),
                    )

    def _hot_flows(self, chain: Sequence[str]) -> Iterator[Flow]:
        """Yield the messages of a chain, to the units that pass it on."""
        for topic in chain:
            if topic not in self.ends:
                known = listed(sorted(self.ends), _MAX_NAMES)
                raise ManycoreError(
                    f"--chain: no topic '{topic}' in mapfile and profile, which have {known}",
                    EXIT_BAD_INPUT,
                )
        for index, topic in enumerate(chain):
            ends = self.ends[topic]
            receivers = ends.receivers
            for following in chain[index + 1 : index + 2]:
                receivers = receivers & set(self.ends[following].publishers)
            for publisher, sent in sorted(ends.publishers.items()):
                others = frozenset(receivers - {publisher})
                if others:
                    yield Flow(topic, publisher, others, sent.messages_per_s, is_hot=True)


def _owners(nodes: Sequence[PlacedNode]) -> Iterator[tuple[str, int]]:
    """Yield full names of nodes and of components, with the index of their node."""
    for index, node in enumerate(nodes):
        yield node.full_name, index
        for one in node.rules.components:
            if one.name:
                yield full_node_name(one.namespace, one.name), index


def _landing_bytes(smem: Smem, entry: TopicEntry | None, depth: int) -> int:
    if entry is None or entry.transfer == "dsm" or entry.topic_dsm_size is None:
        return 0
    return smem.landing(depth, entry.topic_dsm_size)
