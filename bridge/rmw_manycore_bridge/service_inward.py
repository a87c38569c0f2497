# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A service whose server is on the platform, called from outside."""

from __future__ import annotations

import itertools
import time
from functools import partial
from typing import Any

from rclpy.serialization import deserialize_message, serialize_message

from rmw_manycore_bridge.service import Service
from rmw_manycore_bridge.sides import Sides
from rmw_manycore_bridge.topic_inward import never_called
from rmw_manycore_py import _transport

LINGER_S = 1.0  # the service stays while the last answers are on their way, which end with it

_NEVER_S = float("inf")


class InwardService(Service):
    """DDS service -> client on the platform."""

    kind = "service"

    def __init__(self, sides: Sides) -> None:
        super().__init__(sides)
        self._numbers = itertools.count(1)
        self._servers: set[bytes] = set()
        self._ends_s = _NEVER_S  # once the last server has gone
        self._requests: _transport.Publisher | None = None
        self._replies: _transport.Subscription | None = None
        self.entity: Any = None  # the service outside
        self._node: Any = None  # that it belongs to

    def reconcile(self) -> None:
        """Offer the service outside while a server is there inside."""
        found = self._sides.inside.servers(self._sides.route.inside)
        servers = {server.gid for server in found if server.type == self._sides.route.type}
        if self._servers and not self._servers & servers:
            self._abandon()  # whoever replaces them knows nothing of the requests
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
        """When a request is overdue, or the service outside has to go."""
        return min(super().due_s, self._ends_s)

    def expire(self, now_s: float) -> None:
        """Answer the requests whose time is over; leave when the servers have."""
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
        """Pass a request on."""
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
        """Leave both sides; who still waits gets an answer first."""
        self._abandon()
        if self.entity is not None:
            self._sides.inside.readers.remove(self)
            self._sides.outside.readers.remove(self)
            self._node.destroy_service(self.entity)
            self._sides.outside.leave_node(self._sides.route.node)
        self.entity = self._requests = self._replies = None
        self._ends_s = _NEVER_S
