# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Service with its server on the platform, called from outside."""

from __future__ import annotations

import itertools
import time
from functools import partial
from typing import Any

from rmw_manycore_bridge.outside.interface import Server
from rmw_manycore_bridge.service import Service
from rmw_manycore_bridge.sides import Sides
from rmw_manycore_py.native import _transport

LINGER_S = 1.0  # destroying the service would discard replies in flight

_NEVER_S = float("inf")


class InwardService(Service):
    """Server outside -> client on the platform."""

    def __init__(self, sides: Sides) -> None:
        super().__init__(sides)
        self._numbers = itertools.count(1)
        self._servers: set[bytes] = set()
        self._ends_s = _NEVER_S  # set when the last server has gone
        self._requests: _transport.Publisher | None = None
        self._replies: _transport.Subscription | None = None
        self._server: Server | None = None

    def reconcile(self) -> None:
        """Offer the service outside while a server exists on the platform."""
        found = self._sides.inside.servers(self._sides.route.inside)
        servers = {server.gid for server in found if server.type == self._sides.route.type}
        if self._servers and not self._servers & servers:
            self._abandon()  # a new server does not know the pending requests
        self._servers = servers
        if servers:
            self._ends_s = _NEVER_S
            if self._server is None:
                self._appear()
                self._sides.row.set_state("forwarding")
        elif self._server is None:
            self._wait_or_fail([server.type for server in found], "inside")
        elif self._ends_s == _NEVER_S:
            self._ends_s = time.monotonic() + LINGER_S

    @property
    def due_s(self) -> float:  # type: ignore[override]
        """Earliest deadline of a request, or of removing the service outside."""
        return min(super().due_s, self._ends_s)

    def expire(self, now_s: float) -> None:
        """Answer overdue requests; remove the service outside after its servers."""
        super().expire(now_s)
        if now_s >= self._ends_s:
            self.close()
            self.try_to_reconcile()

    def _appear(self) -> None:
        self._replies = self._subscription("reply")
        self._requests = self._publisher("request")
        self._server = self._sides.outside.serve(self._sides.route)
        self._sides.inside.readers.append(self)
        self._sides.outside.readers[self._server] = self.pump_outside

    def pump_outside(self) -> None:
        """Forward a request."""
        with self._one_request():
            taken = self._server.take() if self._server is not None else None
            if taken is not None:
                self._pass_on(*taken)

    def _pass_on(self, caller: Any, data: bytes) -> None:
        if not self._servers:
            self._give_up_without_server(caller)
            return
        with self._one_request(caller):
            self._pending.ask(caller, partial(self._send, data, next(self._numbers)))

    def _send(self, data: bytes, number: int) -> int:
        assert self._requests is not None
        assert self._replies is not None
        self._requests.publish(data, client=self._replies.gid, number=number)
        return number

    def pump_inside(self) -> None:
        """Return replies."""
        replies = self._replies
        if replies is None or not replies.has_data():  # most turns are for other routes
            return
        while (claim := replies.claim()) is not None:
            try:
                asked, data = self._pending.answered(claim.number), claim.data
            finally:
                claim.release()
            if asked is not None:
                with self._one_request(asked.caller):
                    self._answer(asked, data)

    def _reply(self, caller: Any, data: bytes) -> None:
        server = self._server
        if server is not None:
            server.reply(caller, data)

    def close(self) -> None:
        """Leave both sides, after answering pending requests."""
        self._abandon()
        if self._server is not None:
            self._sides.inside.readers.remove(self)
            del self._sides.outside.readers[self._server]
            self._server.close()
        self._server = self._requests = self._replies = None
        self._ends_s = _NEVER_S
