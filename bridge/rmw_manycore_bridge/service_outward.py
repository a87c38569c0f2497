# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Service with its server outside, called from the platform."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from functools import partial

from rmw_manycore_bridge.outside.interface import Answer
from rmw_manycore_bridge.service import Service
from rmw_manycore_bridge.sides import Sides
from rmw_manycore_py.native import _transport

# A server appears in the graph shortly before it is matched, which raises no event. Polling with
# doubling intervals finds it early and rarely polls for a server that never matches.
_MATCHING_S = 0.02
_MATCHED_BY_S = 5.0  # longer than the DDS repetition of discovery data (3 s)

_NEVER_S = float("inf")
Caller = tuple[bytes, int]  # client gid, sequence number of the request


class OutwardService(Service):
    """Server on the platform -> client outside."""

    def __init__(self, sides: Sides) -> None:
        super().__init__(sides)
        # CLOCK_MONOTONIC: since when a server is seen but unmatched, and when to poll again.
        self._seen_s = self._poll_s = _NEVER_S
        # Held while requests are claimed: both threads claim, and no claim may follow the last one.
        self._claiming = threading.Lock()
        self._requests: _transport.Subscription | None = None
        self._replies: _transport.Publisher | None = None
        self._client = sides.outside.call(sides.route)
        sides.outside.readers[self._client] = self.pump_outside

    def reconcile(self) -> None:
        """Offer the service on the platform while a server exists outside."""
        self._poll_s = _NEVER_S
        if not self._client.is_ready():
            self._leave_platform()
            self._poll_for_server()
            return
        self._seen_s = _NEVER_S
        if self._requests is None:
            self._replies = self._publisher("reply")
            self._requests = self._subscription("request")
            self._sides.inside.readers.append(self)
            self._sides.inside.wake()
            self._sides.row.set_state("forwarding")

    def _poll_for_server(self) -> None:
        """Poll for the match of a known server, or fail if it does not match."""
        route, now_s = self._sides.route, time.monotonic()
        found = self._sides.outside.server_types(route.outside)
        if route.type not in found:
            self._seen_s = _NEVER_S
            self._wait_or_fail(found, "outside")
            return
        self._seen_s = min(self._seen_s, now_s)
        waited_s = now_s - self._seen_s
        self._poll_s = now_s + max(waited_s, _MATCHING_S)
        if waited_s > _MATCHED_BY_S:
            self._sides.fail("has a server outside that DDS does not match: its QoS may not fit")
        else:
            self._sides.row.set_state("waiting")

    @property
    def due_s(self) -> float:  # type: ignore[override]
        """Earliest deadline of a request or of the next poll for a match."""
        return min(self._pending.due_s, self._poll_s)

    def expire(self, now_s: float) -> None:
        """Answer overdue requests; poll for the server's match."""
        super().expire(now_s)
        if self._poll_s <= now_s:
            self.try_to_reconcile()

    def pump_inside(self) -> None:
        """Forward requests."""
        requests = self._requests
        if requests is None or not requests.has_data():  # most turns are for other routes
            return
        with self._claiming:
            for caller, data in self._claimed_requests():
                with self._one_request(caller):
                    self._pending.ask(caller, partial(self._client.send, data))
                self._sides.outside.wake()  # its deadline has changed

    def _claimed_requests(self) -> Iterator[tuple[Caller, bytes]]:
        requests = self._requests
        while requests is not None and (claim := requests.claim()) is not None:
            try:
                caller, data = (claim.client, claim.number), claim.data
            finally:
                claim.release()
            yield caller, data

    def pump_outside(self) -> None:
        """Return a reply."""
        with self._one_request():
            answer = self._client.take()
            if answer is not None:
                self._return(answer)

    def _return(self, answer: Answer) -> None:
        asked = self._pending.answered(answer.number)
        if asked is None:
            return
        if answer.data is None:
            self._give_up(asked.caller, "unanswered", answer.reason)
            return
        with self._one_request(asked.caller):
            self._answer(asked, answer.data)

    def _reply(self, caller: Caller, data: bytes) -> None:
        replies = self._replies
        if replies is not None:
            client, number = caller
            replies.publish(data, client=client, number=number)

    def _leave_platform(self) -> None:
        """Answer all callers, then leave atomically: no request may arrive in between."""
        with self._claiming:
            for caller, _ in self._claimed_requests():
                self._give_up_without_server(caller)
            if self._requests is not None:
                self._sides.inside.readers.remove(self)
            self._requests = None
        self._abandon()
        self._replies = None

    def close(self) -> None:
        """Leave both sides, after answering pending requests."""
        self._leave_platform()
        del self._sides.outside.readers[self._client]
        self._client.close()
