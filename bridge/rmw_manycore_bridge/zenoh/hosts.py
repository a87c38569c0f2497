# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The other hosts of a platform as the outside, over sessions of their own.

Each host listens in its inward process, and connects from its outward process to the inward ones of
the others: what a host publishes goes over one link to each host, and no host forwards.
"""

from __future__ import annotations

import zenoh

from rmw_manycore_bridge.outside.interface import Joining, OutsideError
from rmw_manycore_bridge.zenoh.graph import Graph, say
from rmw_manycore_bridge.zenoh.outside import Zenoh
from rmw_manycore_bridge.zenoh.session import open_link


class Hosts(Zenoh):
    """One direction of a host's links."""

    @classmethod
    def open(cls, joining: Joining) -> Hosts:
        """Listen for other hosts, or connect to them once they are there."""
        return cls(joining)

    def _open_session(self, joining: Joining) -> zenoh.Session:
        outside = joining.plan.outside
        if joining.direction == "outward":
            return open_link(listen=[], connect=outside.connect)
        try:
            return open_link(listen=[outside.listen], connect=[])
        except zenoh.ZError as error:
            text = f"cannot listen at {outside.listen}, the address of {outside.host}: {error}"
            raise OutsideError(text) from error

    def _watch(self, _: Joining, graph: Graph) -> HostWatch:
        return HostWatch(self._session, graph)


class HostWatch:
    """Prints when a link to another host comes up, and which host a lost one led to."""

    def __init__(self, session: zenoh.Session, graph: Graph) -> None:
        self._graph = graph
        self._listener = session.info.declare_transport_events_listener(self._noted)

    def _noted(self, event: zenoh.TransportEvent) -> None:
        """Print what has changed, in a thread of zenoh."""
        if event.kind == zenoh.SampleKind.PUT:
            say("connected to another host")
        else:
            nodes = self._graph.forget(str(event.transport.zid)) or {"another host"}
            say(f"lost {', '.join(sorted(nodes))}; connecting again once it is back")

    def close(self) -> None:
        """Listen no more."""
        self._listener.undeclare()
