# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A trace as plain data: processes, threads and events."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

Events = NDArray[Any]  # of EVENT
Ids = NDArray[np.uint64]  # of endpoints

# Layout of TraceEvent in rmw_manycore/transport/layout/trace_layout.hpp.
EVENT = np.dtype(
    [
        ("time_ns", "<i8"),
        ("number", "<u8"),
        ("value", "<u8"),
        ("endpoint", "<u4"),
        ("incarnation", "<u2"),
        ("kind", "<u2"),
    ]
)
NO_ENDPOINT = 0xFFFFFFFF
NO_ID = 0xFFFF_FFFF_FFFF_FFFF  # instead of an EndpointId
_ID_MASK = 0xFFFF_FFFF_FFFF  # events hold 16 bits of the incarnation


class Kind(IntEnum):
    """Kind of event; same as TraceKind in trace_layout.hpp, which documents the fields."""

    PUBLISH_BEGIN = 1
    SERIALIZE_BEGIN = 2
    WRITE = 3
    PUBLISH_END = 4
    SEND = 5
    RECEIVE = 6
    HINT = 7
    WAKE = 8
    WAIT_BEGIN = 9
    WAIT_END = 10
    CLAIM = 11
    RELEASE = 12
    REQUEST = 13
    REPLY = 14
    LOST = 15
    EXPIRED = 16
    REFUSED = 17
    BLOCKED = 18
    MATCH = 19
    JOIN = 20
    LEAVE = 21
    CPU = 22
    SMEM = 23
    BRIDGE_IN = 24
    BRIDGE_OUT = 25
    ALIGN = 26
    RESUME = 27
    PASS = 28
    HAND = 29
    ARRIVE = 30
    DROP = 31
    IN_PLACE = 32
    SUPERSEDED = 33


EndpointId = int
ThreadId = tuple[int, int, int]  # cluster, pid, tid
Row = tuple[int, int, int, int, int, int]  # time, number, value, endpoint, incarnation, kind
RecordId = tuple[EndpointId, int]  # publisher and number; unique on a platform


def endpoint_id(slot: int, incarnation: int) -> EndpointId:
    """Combine slot and incarnation of an endpoint into one number."""
    return (incarnation & 0xFFFF) << 32 | slot


@overload
def endpoint_in(value: int) -> EndpointId: ...
@overload
def endpoint_in(value: Ids) -> Ids: ...
def endpoint_in(value: int | Ids) -> EndpointId | Ids:
    """Return the endpoint in an event's value, or those of a column."""
    if isinstance(value, int):
        return value & _ID_MASK
    ids: Ids = value & np.uint64(_ID_MASK)
    return ids


def endpoint_ids(events: Events) -> Ids:
    """Return the endpoint of each event, or NO_ID."""
    slots = events["endpoint"].astype(np.uint64)
    ids = slots | events["incarnation"].astype(np.uint64) << np.uint64(32)
    found: Ids = np.where(slots == NO_ENDPOINT, np.uint64(NO_ID), ids)
    return found


@dataclass(frozen=True)
class Endpoint:
    """Description of an endpoint."""

    is_publisher: bool
    role: str  # topic, request or reply
    topic: str
    type: str
    node: str  # full name
    cluster: int


@dataclass(frozen=True)
class Thread:
    """Events of one thread."""

    tid: int
    name: str
    events: Events
    lost: int  # number of events lost since the ring was full


@dataclass(frozen=True)
class Process:
    """A process and the events of its threads."""

    pid: int
    cluster: int
    core: int | None
    host_cpu: int | None
    label: str
    is_receive_thread: bool
    is_alive: bool  # when the trace was saved
    threads: tuple[Thread, ...]
    unplaced: int  # events of threads without a ring


@dataclass(frozen=True)
class Trace:
    """A saved trace. Times are ns of CLOCK_MONOTONIC."""

    platform: str
    processes: tuple[Process, ...]
    endpoints: Mapping[EndpointId, Endpoint]
    unplaced: int  # events of processes without a trace file

    def threads(self) -> Iterator[tuple[Process, Thread]]:
        """Yield every thread with its process."""
        for process in self.processes:
            for thread in process.threads:
                yield process, thread

    @property
    def event_count(self) -> int:
        """Number of recorded events."""
        return sum(len(thread.events) for _, thread in self.threads())

    @property
    def lost(self) -> int:
        """Number of lost events."""
        return (
            self.unplaced
            + sum(process.unplaced for process in self.processes)
            + sum(thread.lost for _, thread in self.threads())
        )

    def threads_by_id(self) -> dict[ThreadId, Events]:
        """Return the events of each thread in order.

        A thread has one ring for its nodes, and another for events beside them.
        """
        found: dict[ThreadId, Events] = {}
        for process, thread in self.threads():
            key = (process.cluster, process.pid, thread.tid)
            known = found.get(key)
            if known is None:
                found[key] = thread.events
            else:
                both = np.concatenate([known, thread.events])
                found[key] = both[np.argsort(both["time_ns"], kind="stable")]
        return found

    def topic_of(self, endpoint: EndpointId) -> str:
        """Return the topic of an endpoint, or its number if unknown."""
        named = self.endpoints.get(endpoint)
        return named.topic if named else f"endpoint {endpoint & 0xFFFFFFFF}"

    def node_of(self, endpoint: EndpointId) -> str:
        """Return the node of an endpoint, or its number if unknown."""
        named = self.endpoints.get(endpoint)
        return named.node if named else f"endpoint {endpoint & 0xFFFFFFFF}"
