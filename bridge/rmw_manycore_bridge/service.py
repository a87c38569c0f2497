# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Common part of both directions of a service: forward requests, return replies."""

from __future__ import annotations

import time
from abc import abstractmethod
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from rmw_manycore_bridge.empty_answer import empty_answer
from rmw_manycore_bridge.outside import types
from rmw_manycore_bridge.outside.loop import Mover
from rmw_manycore_bridge.pending import Asked, Pending
from rmw_manycore_bridge.policies import replaced, service_qos
from rmw_manycore_bridge.sides import Sides
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.enums import EndpointRole


class Service(Mover):
    """Runs in the thread of the outside; replies from the platform in the platform's thread."""

    def __init__(self, sides: Sides) -> None:
        super().__init__(sides.fail)
        self._sides = sides
        sides.outside.require_type(sides.route.type)
        self._hash = types.hash_of(sides.route.type)
        self._pending = Pending(sides.route.timeout_s)

    @property
    def due_s(self) -> float:  # type: ignore[override]
        """Earliest deadline of a request."""
        return self._pending.due_s

    def _wait_or_fail(self, types_found: list[str], where: str) -> None:
        """Wait for a server, or fail with the type of the server that does not match."""
        if types_found:
            self._sides.fail(f"is {types_found[0]} {where}, not {self._sides.route.type}")
        else:
            self._sides.row.set_state("waiting")

    def _publisher(self, role: EndpointRole) -> _transport.Publisher:
        route, process = self._sides.route, self._sides.inside.process
        return process.publisher(route.inside, route.type, service_qos(), role, self._hash)

    def _subscription(self, role: EndpointRole) -> _transport.Subscription:
        """Return a subscription that never overwrites unread messages (KEEP_ALL)."""
        route, process = self._sides.route, self._sides.inside.process
        qos = replaced(service_qos(), {"history": "keep_all"})
        return process.subscription(route.inside, route.type, qos, role, self._hash)

    @abstractmethod
    def _reply(self, caller: Any, data: bytes) -> None:
        """Send a response to the caller."""

    def _answer(self, asked: Asked, data: bytes) -> None:
        self._reply(asked.caller, data)
        self._sides.row.passed(len(data), time.time_ns() - asked.since_ns)

    @contextmanager
    def _one_request(self, caller: Any = None) -> Iterator[None]:
        """Confine an error to one request, and answer its caller if known.

        Either side may reject a request: it is too large, malformed, or its caller has ended.
        """
        try:
            yield
        except Exception as error:
            if self._sides.row.add("refused") == 1:
                self._sides.report(str(error))
            if caller is not None:
                self._answer_empty(caller, str(error))

    def expire(self, now_s: float) -> None:
        """Answer the requests whose deadline has passed."""
        timeout_s = self._sides.route.timeout_s
        for asked in self._pending.overdue(now_s):
            self._give_up(asked.caller, "timed_out", f"no reply within {timeout_s:g} s")

    def _abandon(self) -> None:
        """Answer all pending requests, since their server has gone."""
        for asked in self._pending.all():
            self._give_up_without_server(asked.caller)

    def _give_up_without_server(self, caller: Any) -> None:
        self._give_up(caller, "unanswered", "the server is gone")

    def _give_up(self, caller: Any, counter: str, reason: str) -> None:
        self._sides.row.add(counter)
        self._sides.report(reason)
        self._answer_empty(caller, reason)

    def _answer_empty(self, caller: Any, reason: str) -> None:
        try:
            self._reply(caller, empty_answer(self._sides.route.type, f"bridge: {reason}"))
        except Exception as error:  # the caller may have ended; the request is counted
            self._sides.report(f"cannot answer a caller: {error}")
