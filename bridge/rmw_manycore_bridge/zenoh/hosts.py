# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The other hosts of a platform as the outside, over sessions of their own.

Each host listens in its inward process. It has an outward process for each other host, which
connects to the inward one there: a slow link holds up its own process only, and no host forwards.
"""

from __future__ import annotations

import zenoh

from rmw_manycore_bridge.outside.interface import Endpoint, Joining, Platform
from rmw_manycore_bridge.zenoh.graph import LINK_NODE, Graph, report
from rmw_manycore_bridge.zenoh.host_graph import HostPublisher, OtherNodes, OwnNodes, Source
from rmw_manycore_bridge.zenoh.outside import Zenoh
from rmw_manycore_bridge.zenoh.session import open_connecting, open_listening
from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.routes.route import Route


class Hosts(Zenoh):
    """The link to one host, or the links from all others."""

    links_platforms = True
    _is_late = False  # whether it waits, or had to wait, for its address

    @classmethod
    def open(cls, joining: Joining) -> Hosts:
        """Listen for other hosts, or connect to them once they are there."""
        return cls(joining)

    def _open_session(self, joining: Joining) -> zenoh.Session:
        outside = joining.plan.outside
        self._sources: dict[str, dict[bytes, Source]] = {}  # by topic and gid
        self._is_outward = joining.direction == "outward"
        if joining.direction == "outward":
            return open_connecting(outside.connect)
        try:
            return open_listening(outside.listen, waits=False)
        except zenoh.ZError as error:  # its interface is not up, or its port in use
            text = f"cannot listen at {outside.listen}, the address of {outside.host}: {error}"
            report(f"{text}; trying again")
            self._is_late = True
            return open_listening(outside.listen, waits=True)

    def _watch(self, _: Joining, graph: Graph) -> HostWatch:
        return HostWatch(self._session, graph)

    def publishers(self, route: Route, _: bool) -> list[Endpoint]:
        """Return the publishers of a topic on other hosts, with their nodes."""
        found = self._graph.endpoints("MP", route.outside)
        return [
            Endpoint(self._type_of(t), self._qos_of(t), t.full_node_name, t.gid, t.source)
            for t in found
        ]

    def publish(self, route: Route, qos: Qos) -> HostPublisher:
        """Create a publisher."""
        sources = self._sources.setdefault(route.outside, {})
        token = self._token("MP", route, qos)
        made = HostPublisher(self._graph, token, self._note_change, sources)
        made.declare(self._session, self._key(route), qos)
        return made

    def show_nodes(self, platform: Platform) -> None:
        """Show this host's nodes on the others, or theirs here."""
        if self._is_outward:
            platform.movers.append(OwnNodes(platform, self._graph))
        else:
            self.movers.append(OtherNodes(platform, self._graph))

    def close(self) -> None:
        """Leave the platform's hosts."""
        if not self._is_late:  # to close it may take 10 s; it ends with the process
            super().close()


class HostWatch:
    """Prints when a link to another host comes up, and which host a lost one led to."""

    def __init__(self, session: zenoh.Session, graph: Graph) -> None:
        self._graph = graph
        self._listener = session.info.declare_transport_events_listener(self._noted)

    def _noted(self, event: zenoh.TransportEvent) -> None:
        """Print what has changed, in a thread of zenoh."""
        if event.kind == zenoh.SampleKind.PUT:
            report("connected to another host")
        else:
            nodes = self._graph.forget(str(event.transport.zid))
            links = (n.removeprefix(LINK_NODE) for n in nodes if n.startswith(LINK_NODE))
            host = next((f"host {link.rpartition('_')[0]}" for link in links), "another host")
            report(f"lost {host}; connecting again once it is back")

    def close(self) -> None:
        """Listen no more."""
        self._listener.undeclare()
