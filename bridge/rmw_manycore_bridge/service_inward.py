# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Service with its server on the platform, called from DDS."""

from __future__ import annotations

import itertools
import time
from functools import partial
from typing import Any

from rclpy.serialization import deserialize_message, serialize_message

from rmw_manycore_bridge.service import Service
from rmw_manycore_bridge.sides import Sides
from rmw_manycore_bridge.topic_inward import never_called
from rmw_manycore_py.native import _transport

LINGER_S = 1.0  # destroying the service would discard replies in flight

_NEVER_S = float("inf")


class InwardService(Service):
    """DDS service -> client on the platform."""

    kind = "service"

    def __init__(self, sides: Sides) -> None:
        super().__init__(sides)
        self._numbers = itertools.count(1)
        self._servers: set[bytes] = set()
        self._ends_s = _NEVER_S  # set when the last server has gone
        self._requests: _transport.Publisher | None = None
        self._replies: _transport.Subscription | None = None
        self.entity: Any = None  # the DDS service
        self._node: Any = None  # node of the DDS service

    def reconcile(self) -> None:
        """Offer the DDS service while a server exists on the platform."""
        found = self._sides.inside.servers(self._sides.route.inside)
        servers = {server.gid for server in found if server.type == self._sides.route.type}
        if self._servers and not self._servers & servers:
            self._abandon()  # a new server does not know the pending requests
        self._servers = servers
        if servers:
            self._ends_s = _NEVER_S
            if self.entity is None:
                self._appear()
                self._sides.row.set_state("forwarding")
        elif self.entity is None:
            self._wait_or_fail([server.type for server in found], "inside")
        elif self._ends_s == _NEVER_S:
            self._ends_s = time.monotonic() + LINGER_S

    @property
    def due_s(self) -> float:  # type: ignore[override]
        """Earliest deadline of a request, or of removing the DDS service."""
        return min(super().due_s, self._ends_s)

    def expire(self, now_s: float) -> None:
        """Answer overdue requests; remove the DDS service after its servers."""
        super().expire(now_s)
        if now_s >= self._ends_s:
            self.close()
            self.try_to_reconcile()

    def _appear(self) -> None:
        self._replies = self._subscription("reply")
        self._requests = self._publisher("request")
        self._node = self._sides.outside.enter_node(self._sides.route.node)
        try:
            self.entity = self._node.create_service(
                self._type, self._sides.route.outside, never_called
            )
        except Exception:
            self._sides.outside.leave_node(self._sides.route.node)
            raise
        self._sides.inside.readers.append(self)
        self._sides.outside.readers.append(self)

    def pump_outside(self) -> None:
        """Forward a request."""
        with self._one_request():
            request, header = self.entity.handle.service_take_request(self._type.Request)
            if request is not None:
                self._pass_on(request, header)

    def _pass_on(self, request: Any, header: Any) -> None:
        if not self._servers:
            self._give_up_without_server(header)
            return
        with self._one_request(header):
            data, number = serialize_message(request), next(self._numbers)
            self._pending.ask(header, partial(self._send, data, number))

    def _send(self, data: bytes, number: int) -> int:
        assert self._requests is not None
        assert self._replies is not None
        self._requests.publish(data, client=self._replies.gid, number=number)
        return number

    def pump_inside(self) -> None:
        """Return replies."""
        replies = self._replies
        while replies is not None and (claim := replies.claim()) is not None:
            try:
                asked, data = self._pending.answered(claim.number), claim.data
            finally:
                claim.release()
            if asked is not None:
                with self._one_request(asked.caller):
                    response = deserialize_message(data, self._type.Response)
                    self._answer(asked, response, len(data))

    def _reply(self, caller: Any, response: Any) -> None:
        entity = self.entity
        if entity is not None:
            entity.handle.service_send_response(response, caller.request_id)

    def close(self) -> None:
        """Leave both sides, after answering pending requests."""
        self._abandon()
        if self.entity is not None:
            self._sides.inside.readers.remove(self)
            self._sides.outside.readers.remove(self)
            self._node.destroy_service(self.entity)
            self._sides.outside.leave_node(self._sides.route.node)
        self.entity = self._requests = self._replies = None
        self._ends_s = _NEVER_S
