# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Profiles of applications that ros2_tracing or CARET traced with LTTng."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from rmw_manycore_py.errors import FileError, Problem
from rmw_manycore_py.profile.babeltrace import Reader
from rmw_manycore_py.profile.distributions import SHARES, distribution_of, intervals_of
from rmw_manycore_py.profile.entities import Entities
from rmw_manycore_py.profile.executions import Executions
from rmw_manycore_py.profile.model import (
    FORMAT,
    VERSION,
    Callback,
    CallbackGroup,
    Coverage,
    Executor,
    Node,
    Output,
    Process,
    Profile,
    Publisher,
    Subscription,
)
from rmw_manycore_py.profile.seen import CallbackSeen, PublisherSeen

_FOREVER = 1 << 62


@dataclass(frozen=True)
class Window:
    """A part of a trace, from its first event on."""

    begin_ns: int = 0
    end_ns: int | None = None


def import_trace(path: Path, window: Window) -> Profile:
    """Return the profile of a CTF trace, a directory.

    :raises ManycoreError: if babeltrace2 is missing; FileError if the trace cannot be used.
    """
    reader = Reader(path)
    entities = Entities()
    executions = Executions(entities)
    span = _read(reader, entities, executions, window)
    if not span.events:
        raise FileError(Problem(path, 0, "", "events of ros2_tracing (ros2:...)", "none"))
    return _profile(reader, entities, executions, span)


@dataclass(frozen=True)
class _Span:
    """What was read of a trace."""

    events: int
    duration_ns: int


def _read(reader: Reader, entities: Entities, executions: Executions, window: Window) -> _Span:
    handlers = {
        "ros2:callback_start": executions.begin,
        "ros2:callback_end": executions.end,
        "ros2:rcl_publish": executions.publish,
    }
    count = first_ns = last_ns = 0
    end_ns = _FOREVER if window.end_ns is None else window.end_ns
    for event in reader.events():
        if not count:
            first_ns = event.time_ns
        last_ns = event.time_ns
        count += 1
        handler = handlers.get(event.name)
        if handler is None:
            entities.handle(event)
        elif window.begin_ns <= last_ns - first_ns <= end_ns:
            handler(event)
    return _Span(count, max(min(last_ns - first_ns, end_ns) - window.begin_ns, 0))


def _profile(reader: Reader, entities: Entities, executions: Executions, span: _Span) -> Profile:
    pids = {pid: index for index, pid in enumerate(reader.process_names)}
    tids = {pid: sorted(executions.tids.get(pid, ())) for pid in pids}
    return Profile(
        format=FORMAT,
        version=VERSION,
        source="ros2_tracing",
        events=span.events,
        duration_ns=span.duration_ns,
        quantile_shares=SHARES,
        processes=tuple(
            Process(name=name, threads=len(tids[pid])) for pid, name in reader.process_names.items()
        ),
        nodes=tuple(Node(name=node.name, process=pids[node.pid]) for node in entities.nodes),
        publishers=tuple(map(_publisher, entities.publishers)),
        subscriptions=tuple(
            Subscription(node=_index(one.node), topic=one.name, queue_depth=one.queue_depth)
            for one in entities.subscriptions
        ),
        executors=tuple(
            Executor(name=f"executor_{one.index}", kind=one.kind) for one in entities.executors
        ),
        groups=tuple(
            CallbackGroup(name=f"group_{one.index}", kind=one.kind, executor=_index(one.executor))
            for one in entities.groups
        ),
        callbacks=tuple(
            _callback(one, pids[one.pid], tids[one.pid], span)
            for one in executions.callbacks
            if one.durations_ns
        ),
        chains=(),
        coverage=Coverage(**{**executions.counts, "discarded_events": reader.discarded}),
    )


def _publisher(one: PublisherSeen) -> Publisher:
    return Publisher(
        node=_index(one.node),
        topic=one.topic,
        queue_depth=one.queue_depth,
        publications=len(one.times_ns),
        outside_callbacks=one.outside_callbacks,
        interval_ns=intervals_of(one.times_ns),
        size_bytes=None,
    )


def _callback(one: CallbackSeen, process: int, tids: list[int], span: _Span) -> Callback:
    trigger = one.trigger
    executions = len(one.durations_ns)
    return Callback(
        kind=trigger.kind,
        node=_index(trigger.node),
        trigger=trigger.name,
        subscription=trigger.index,
        period_ns=trigger.period_ns,
        symbol=one.symbol,
        process=process,
        threads=tuple(sorted(map(tids.index, one.tids))),
        group=_index(trigger.group),
        executions=executions,
        rate_hz=executions * 1e9 / span.duration_ns if span.duration_ns else None,
        wall_ns=distribution_of(one.durations_ns),
        cpu_ns=None,
        interval_ns=intervals_of(one.begins_ns),
        publishes=tuple(
            Output(
                publisher=publisher.index,
                count=len(offsets_ns),
                offset_ns=distribution_of(offsets_ns),
            )
            for publisher, offsets_ns in one.offsets_ns.items()
        ),
        dispatch_ns=distribution_of(one.dispatch_ns),
        queued_ns=distribution_of(one.queued_ns),
        age_ns=distribution_of(one.age_ns),
    )


class _Indexed(Protocol):
    index: int


def _index(one: _Indexed | None) -> int | None:
    return None if one is None else one.index
