# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Servers and clients of zenoh: queryables and queriers, with serialized data."""

from __future__ import annotations

import itertools
import time
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import zenoh
from zenoh.handlers import Callback

from rmw_manycore_bridge.outside.interface import Answer, OutsideError
from rmw_manycore_bridge.zenoh.attachment import Attachment, pack, unpack
from rmw_manycore_bridge.zenoh.graph import Declared, Graph

_NO_GID = bytes(16)
# The bridge times requests itself; an action's result may take as long as it likes.
_FOREVER_S, _MARGIN_S = 1e7, 1.0


class _Caller(NamedTuple):
    query: zenoh.Query
    attachment: Attachment


class ZenohServer:
    """Queryable; the attachment of a request returns with its response."""

    def __init__(
        self, session: zenoh.Session, key: str, declared: Declared, notify: Callable[[], None]
    ) -> None:
        self._declared, self._key, self._notify = declared, key, notify
        self._arrived: deque[tuple[_Caller, bytes]] = deque()
        self._entity = session.declare_queryable(
            key, Callback(self._note, indirect=False), complete=True
        )

    def _note(self, query: zenoh.Query) -> None:
        """Keep a request, in a thread of zenoh."""
        attached, payload = query.attachment, query.payload
        found = unpack(attached.to_bytes()) if attached is not None else None
        caller = _Caller(query, found or Attachment(0, 0, _NO_GID))
        self._arrived.append((caller, b"" if payload is None else payload.to_bytes()))
        self._notify()

    def has_data(self) -> bool:
        """Return whether a request waits."""
        return bool(self._arrived)

    def take(self) -> tuple[_Caller, bytes] | None:
        """Take the next request."""
        return self._arrived.popleft() if self._arrived else None

    def reply(self, caller: _Caller, data: bytes) -> None:
        """Send a response."""
        asked = caller.attachment
        attachment = pack(asked.number, time.time_ns(), asked.gid)
        try:
            caller.query.reply(self._key, data, attachment=attachment)
            caller.query.drop()  # ends the caller's query
        except zenoh.ZError as error:
            raise OutsideError(str(error)) from error

    def close(self) -> None:
        """Destroy it."""
        self._declared.withdraw()
        self._entity.undeclare()


class ZenohClient:
    """Querier of all servers of the service; the first response counts."""

    def __init__(
        self,
        session: zenoh.Session,
        key: str,
        graph: Graph,
        declared: Declared,
        timeout_s: float | None,
        notify: Callable[[], None],
    ) -> None:
        self._graph, self._declared, self._notify = graph, declared, notify
        self._gid = declared.token.gid
        self._numbers = itertools.count(1)
        self._arrived: deque[Answer] = deque()
        self._entity = session.declare_querier(
            key,
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=_FOREVER_S if timeout_s is None else timeout_s + _MARGIN_S,
        )

    def is_ready(self) -> bool:
        """Return whether the graph has a server of this type."""
        own = self._declared.token
        servers = self._graph.endpoints("SS", own.name)
        return any((t.type, t.type_hash) == (own.type, own.type_hash) for t in servers)

    def send(self, data: bytes) -> int:
        """Send a request."""
        number = next(self._numbers)
        attachment = pack(number, time.time_ns(), self._gid)
        try:
            # Otherwise each call starts a thread for its answer.
            answered = Callback(partial(self._note, number), indirect=False)
            self._entity.get(answered, payload=data, attachment=attachment)
        except zenoh.ZError as error:
            raise OutsideError(str(error)) from error
        return number

    def _note(self, number: int, reply: zenoh.Reply) -> None:
        """Keep an answer, in a thread of zenoh."""
        if reply.ok is not None:
            answer = Answer(number, reply.ok.payload.to_bytes())
        else:
            reason = reply.err.payload.to_bytes().decode(errors="replace") if reply.err else ""
            answer = Answer(number, None, reason or "the server replied with an error")
        self._arrived.append(answer)
        self._notify()

    def has_data(self) -> bool:
        """Return whether an answer waits."""
        return bool(self._arrived)

    def take(self) -> Answer | None:
        """Take the next answer."""
        return self._arrived.popleft() if self._arrived else None

    def close(self) -> None:
        """Destroy it."""
        self._declared.withdraw()
        self._entity.undeclare()
