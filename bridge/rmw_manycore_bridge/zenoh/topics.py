# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Subscriptions and publishers of zenoh, with serialized messages."""

from __future__ import annotations

import ctypes
import itertools
import time
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from threading import Event
from typing import Any, NamedTuple

import xxhash
import zenoh
from zenoh import ext
from zenoh.handlers import Callback

from rmw_manycore_bridge.outside.interface import OutsideError
from rmw_manycore_bridge.zenoh.attachment import pack, unpack
from rmw_manycore_bridge.zenoh.graph import Declared, Graph, report
from rmw_manycore_bridge.zenoh.keys import Token
from rmw_manycore_py.native._transport import EndpointInfo, Qos

_SCOUT_DEPTH = 10
_MAX_HOLD_UP_S, _STEP_S = 1.0, 0.05  # far longer than a turn of the bridge takes
_HEARTBEAT_S = 0.5  # as rmw_zenoh: period in which the last number is repeated, if it has changed
_OLD_PEER = (
    "messages have the attachment of rmw_zenoh before 0.2.4: they are passed on, but it cannot "
    "read those of the bridge"
)
_OTHER_TYPE = "messages of another type are dropped"
_NO_NUMBERS = "messages have no attachment of rmw_zenoh: lost ones cannot be counted"


class _Message(NamedTuple):
    publisher: bytes
    number: int
    sent_ns: int
    data: bytes


# Called in the thread of zenoh that has received something, with its subscription.
Notify = Callable[["ZenohSubscription"], None]


class ZenohSubscription:
    """Keeps arrived messages until they are taken.

    When full it holds up the link if messages are reliable: their sender then waits, or drops them
    and leaves a gap in the numbers. Otherwise, or after a while, it drops the oldest, which leaves
    such a gap, too.
    """

    def __init__(self, key: str, notify: Notify, left: Callable[[], object] = bool) -> None:
        self._key, self._notify, self._left = key, notify, left
        self._arrived: deque[_Message] = deque()
        self._depth = _SCOUT_DEPTH
        self._is_reliable = True  # until the QoS is known
        self._room = Event()
        self._said: set[str] = set()
        # Of messages without numbers; a process that replaces this one goes on with higher ones.
        self._numbers = itertools.count(time.time_ns())
        self._message = _Message(b"", 0, 0, b"")
        self._entity: Any = None
        self._declared: Declared | None = None

    def declare(self, session: zenoh.Session, key: str, qos: Qos) -> None:
        """Begin to receive."""
        received = Callback(self._note, indirect=False)  # in the thread that reads the link
        if qos.durability == "volatile":
            self._entity = session.declare_subscriber(key, received)
            return
        is_reliable = qos.reliability == "reliable"
        self._entity = ext.declare_advanced_subscriber(
            *(session, key, received),
            history=ext.HistoryConfig(detect_late_publishers=True, max_samples=qos.depth),
            recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True)
            if is_reliable
            else None,
            subscriber_detection=True,
        )

    def keep(self, qos: Qos) -> None:
        """Keep as many messages as the QoS demands."""
        self._depth = qos.depth
        self._is_reliable = qos.reliability == "reliable"

    def appear(self, declared: Declared, notify: Notify) -> None:
        """Take over the token in the graph, and notify of messages as a route wants it."""
        self._declared, self._notify = declared, notify

    @property
    def is_in_graph(self) -> bool:
        """Whether it has a token: a route takes its messages."""
        return self._declared is not None

    def _note(self, sample: zenoh.Sample) -> None:
        """Keep a message, in a thread of zenoh."""
        if sample.kind != zenoh.SampleKind.PUT:
            return
        if str(sample.key_expr) != self._key:
            self._report_once(f"{_OTHER_TYPE}: {str(sample.key_expr)!a}", _OTHER_TYPE)
            return
        message = self._message_of(sample)
        if self._is_reliable and self._is_full():
            self._wait_for_room()
        if self._is_full():
            with suppress(IndexError):  # taken meanwhile
                self._arrived.popleft()
        self._arrived.append(message)
        self._notify(self)

    def _is_full(self) -> bool:
        return len(self._arrived) >= self._depth

    def _wait_for_room(self) -> None:
        end_s = time.monotonic() + _MAX_HOLD_UP_S
        while self._is_reliable and self._is_full() and time.monotonic() < end_s:
            self._room.clear()
            if self._is_full():
                self._room.wait(_STEP_S)

    def _message_of(self, sample: zenoh.Sample) -> _Message:
        data, attached = sample.payload.to_bytes(), sample.attachment
        found = unpack(attached.to_bytes()) if attached is not None else None
        if found is None:
            self._report_once(_NO_NUMBERS)
            gid = xxhash.xxh3_128_digest(str(sample.key_expr).encode())
            return _Message(gid, next(self._numbers), time.time_ns(), data)
        if found.is_old:
            self._report_once(_OLD_PEER)
        return _Message(found.gid, found.number, found.sent_ns, data)

    def _report_once(self, text: str, problem: str = "") -> None:
        if (problem or text) not in self._said:
            self._said.add(problem or text)
            report(f"{self._key.split('/', 1)[1].rsplit('/', 2)[0]}: {text}")

    def has_data(self) -> bool:
        """Return whether a message waits."""
        return bool(self._arrived)

    def take(self) -> bool:
        """Take the next message."""
        if not self._arrived:
            return False
        self._message = self._arrived.popleft()
        self._room.set()
        return True

    @property
    def publisher(self) -> bytes:
        """Gid of the publisher."""
        return self._message.publisher

    @property
    def number(self) -> int:
        """Sequence number."""
        return self._message.number

    @property
    def sent_ns(self) -> int:
        """Source timestamp."""
        return self._message.sent_ns

    @property
    def address(self) -> int:
        """Address of the message."""
        return ctypes.cast(ctypes.c_char_p(self._message.data), ctypes.c_void_p).value or 0

    @property
    def size(self) -> int:
        """Size of the message."""
        return len(self._message.data)

    def matched(self) -> int:
        """Return 0: zenoh does not report how many publishers know of it."""
        return 0

    def close(self) -> None:
        """Destroy it."""
        if self._declared is not None:
            self._declared.withdraw()
        self._is_reliable = False
        self._arrived.clear()
        self._room.set()
        self._entity.undeclare()
        self._left()


class ZenohPublisher:
    """Publisher that waits for room on a slow link; what it misses meanwhile, the source counts."""

    def __init__(self, graph: Graph, token: Token, changed: Callable[[], None]) -> None:
        self._graph, self._token, self._changed = graph, token, changed
        self.gid = token.gid
        self._declared: Declared | None = None
        self._numbers = itertools.count(1)
        self._entity: Any = None
        self._listener: Any = None

    def declare(self, session: zenoh.Session, key: str, qos: Qos) -> None:
        """Begin to publish."""
        is_reliable = qos.reliability == "reliable"
        # DROP would lose messages that are counted nowhere; that is left to the subscription that
        # they come from, where a publisher is never held up.
        link: dict[str, Any] = {
            "congestion_control": zenoh.CongestionControl.BLOCK,
            "reliability": zenoh.Reliability.RELIABLE
            if is_reliable
            else zenoh.Reliability.BEST_EFFORT,
        }
        if qos.durability == "volatile":
            self._entity = session.declare_publisher(key, **link)
            self._listener = self._entity.declare_matching_listener(lambda _: self._changed())
            return
        self._entity = ext.declare_advanced_publisher(
            *(session, key),
            **link,
            cache=ext.CacheConfig(max_samples=qos.depth),
            sample_miss_detection=ext.MissDetectionConfig(
                heartbeat=None, sporadic_heartbeat=_HEARTBEAT_S
            )
            if is_reliable
            else None,
            publisher_detection=True,
        )

    def appear(self) -> None:
        """Put it into the graph."""
        self._declared = self._graph.declare(self._token)

    def show(self, _: Sequence[EndpointInfo]) -> None:
        """Nothing: in the domain, the bridge is the publisher."""

    def resume(self) -> None:
        """Nothing: messages without subscribers are not lost."""

    def publish(self, address: int, size: int, sent_ns: int, publisher: bytes, number: int) -> None:
        """Publish with the source timestamp of the platform's publisher."""
        gid, own_number = self.identity(publisher, number)
        attachment = pack(own_number, sent_ns, gid)
        try:
            self._entity.put(ctypes.string_at(address, size), attachment=attachment)
        except zenoh.ZError as error:
            raise OutsideError(str(error)) from error

    def identity(self, _publisher: bytes, _number: int) -> tuple[bytes, int]:
        """Return gid and number outside of a message of a platform's publisher."""
        return self.gid, next(self._numbers)

    def has_listeners(self) -> bool:
        """Return whether others subscribe, with a token in the graph or without any."""
        name = self._token.name
        if self._fitting():
            return True
        is_matched = self._listener is not None and self._entity.matching_status.matching
        return is_matched and not self._graph.has_any("MS", name)

    def matched(self) -> int:
        """Return the number of subscriptions in the graph."""
        return self._fitting()

    def _fitting(self) -> int:
        token = self._token
        found = self._graph.endpoints("MS", token.name)
        return sum((t.type, t.type_hash) == (token.type, token.type_hash) for t in found)

    def is_acknowledged(self) -> bool:
        """Return True: zenoh has handed to the link what `publish` has returned from."""
        return True

    def close(self) -> None:
        """Destroy it."""
        if self._declared is not None:
            self._declared.withdraw()
        self._entity.undeclare()
