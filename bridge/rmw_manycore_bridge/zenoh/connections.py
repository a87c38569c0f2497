# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Tells when the session loses a router or a peer, and when it has a router again."""

from __future__ import annotations

from collections.abc import Sequence

import zenoh

from rmw_manycore_bridge.zenoh.graph import Graph, report
from rmw_manycore_bridge.zenoh.session import DEFAULT_CONNECT


class Connections:
    """Called in a thread of zenoh."""

    def __init__(self, session: zenoh.Session, connect: Sequence[str], graph: Graph) -> None:
        self._graph = graph
        self._where = ", ".join(connect or DEFAULT_CONNECT)
        self._is_missing = False
        self._listener = session.info.declare_transport_events_listener(self._noted)
        if not session.info.routers_zid() and not session.info.peers_zid():
            self._miss(f"no zenoh router at {self._where}: nothing crosses before there is one")

    def _miss(self, text: str) -> None:
        self._is_missing = True
        report(text)

    def _noted(self, event: zenoh.TransportEvent) -> None:
        is_router = event.transport.whatami == zenoh.WhatAmI.ROUTER
        if event.kind == zenoh.SampleKind.PUT:
            if is_router and self._is_missing:
                self._is_missing = False
                report(f"connected to the router at {self._where}")
        elif is_router:
            self._miss(f"the router at {self._where} is gone; connecting again once it is back")
        elif nodes := self._graph.forget(str(event.transport.zid)):
            report(f"lost the peer with {', '.join(sorted(nodes))}")

    def close(self) -> None:
        """Listen no more."""
        self._listener.undeclare()
