# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes and publishers of one host as the others see them: under their own names."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rmw_manycore_bridge.outside.interface import Platform
from rmw_manycore_bridge.outside.loop import Mover
from rmw_manycore_bridge.zenoh import qos as qos_text
from rmw_manycore_bridge.zenoh.graph import LINK_NODE, Declared, Graph, StandIn, report
from rmw_manycore_bridge.zenoh.keys import Token
from rmw_manycore_bridge.zenoh.topics import ZenohPublisher
from rmw_manycore_py.native._transport import EndpointInfo, Node
from rmw_manycore_py.ros.names import full_node_name


@dataclass
class Source:
    """A publisher of this host.

    :ivar sent: number of its last message on the link.
    :ivar number: its number on the platform.
    :ivar resumes: whether messages in between were not wanted, or the other host was gone.
    """

    declared: Declared
    sent: int = 0
    number: int | None = None
    resumes: bool = False

    def next(self, number: int) -> int:
        """Return the number on the link of the next message.

        It leaves out what was published while nothing crossed: a subscription that was there all
        the time counts that as lost. What was lost before the link is counted there.
        """
        if self.number is not None and number <= self.number:  # latched, forwarded again
            return self.sent + number - self.number
        self.sent += number - self.number if self.resumes and self.number is not None else 1
        self.number, self.resumes = number, False
        return self.sent


class HostPublisher(ZenohPublisher):
    """Publishes for the publishers of its host, each with a token, a gid and numbers.

    The last messages of a publisher that has ended have the gid of this one.
    """

    def __init__(
        self,
        graph: Graph,
        token: Token,
        changed: Callable[[], None],
        sources: dict[bytes, Source],
    ) -> None:
        super().__init__(graph, token, changed)
        self._sources = sources  # by gid; those of another one of the topic before

    def resume(self) -> None:
        """Go on after a time in which no other host subscribed, or was there."""
        for source in self._sources.values():
            source.resumes = True

    def show(self, sources: Sequence[EndpointInfo]) -> None:
        """Show the platform's publishers in the graph, as long as they are there."""
        present = {source.gid: source for source in sources}
        for gid in self._sources.keys() - present.keys():
            self._hide(gid)
        for gid in present.keys() - self._sources.keys():
            self._sources[gid] = Source(self._graph.declare(self._token_of(present[gid])))

    def _token_of(self, source: EndpointInfo) -> Token:
        own, node = self._token, full_node_name(source.node_namespace, source.node_name)
        qos = qos_text.encode(source.qos)
        return self._graph.token("MP", node, own.name, own.type, own.type_hash, qos, source.gid)

    def _hide(self, gid: bytes) -> None:
        self._sources.pop(gid).declared.withdraw()

    def identity(self, publisher: bytes, number: int) -> tuple[bytes, int]:
        """Return gid and number on the link of a message of a platform's publisher."""
        source = self._sources.get(publisher)
        if source is None:
            return super().identity(publisher, number)
        return source.declared.token.gid, source.next(number)


class OwnNodes(Mover):
    """Shows this host's nodes to another."""

    def __init__(self, platform: Platform, graph: Graph) -> None:
        super().__init__(report)
        self._platform, self._graph = platform, graph
        self._shown: dict[str, StandIn] = {}

    def reconcile(self) -> None:
        """Follow the platform's graph."""
        nodes = self._platform.nodes()
        for name in self._shown.keys() - nodes:
            self._shown.pop(name).leave()
        for name in nodes - self._shown.keys():
            self._shown[name] = self._graph.show_node(name)

    def close(self) -> None:
        """Nothing: the session withdraws all tokens."""


class OtherNodes(Mover):
    """Shows the nodes of other hosts on this platform."""

    def __init__(self, platform: Platform, graph: Graph) -> None:
        super().__init__(report)
        self._platform, self._graph = platform, graph
        self._shown: dict[str, Node] = {}

    def reconcile(self) -> None:
        """Follow the graph of the other hosts."""
        nodes = {name for name in self._graph.nodes() if not name.startswith(LINK_NODE)}
        self._shown = {name: self._platform.stand_in(name) for name in nodes}

    def close(self) -> None:
        """Remove the nodes."""
        self._shown.clear()
