# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Recorded events of a platform that have not been saved."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.trace.events import (
    EVENT,
    Endpoint,
    Kind,
    Process,
    Thread,
    Trace,
    endpoint_id,
)
from rmw_manycore_py.trace.pairs import split_by

_ROLES = ("topic", "request", "reply")


@contextmanager
def recorded(platform: str) -> Iterator[Trace]:
    """Yield the recorded events; unless the block raises, they count as saved.

    Their rings are then freed, and the files of ended processes removed.
    """
    with translate_native_errors():
        saver = _transport.TraceSaver(platform)
    with saver:
        yield _trace_of(platform, saver)
        saver.finish()


def looked_at(platform: str) -> Trace:
    """Return the recorded events without consuming them."""
    with translate_native_errors():
        saver = _transport.TraceSaver(platform)
    with saver:
        return _trace_of(platform, saver)


def _trace_of(platform: str, saver: _transport.TraceSaver) -> Trace:
    endpoints: dict[int, Endpoint] = {}
    processes = []
    for process in saver.processes:
        processes.append(_process_of(process))
        for name in process.names:
            endpoints[endpoint_id(name.slot, name.incarnation)] = Endpoint(
                name.is_publisher,
                _ROLES[name.role] if name.role < len(_ROLES) else "topic",
                name.topic,
                name.type,
                name.node,
                name.cluster,
            )
    return Trace(platform, tuple(processes), endpoints, saver.unplaced)


def _process_of(process: _transport.ProcessTrace) -> Process:
    return Process(
        pid=process.pid,
        cluster=process.cluster,
        core=_unless_negative(process.core),
        host_cpu=_unless_negative(process.host_cpu),
        label=process.label,
        is_receive_thread=process.process is None,
        is_alive=process.alive,
        threads=tuple(thread for t in process.threads for thread in _threads_of(t)),
        unplaced=process.unplaced,
    )


def _threads_of(thread: _transport.ThreadTrace) -> Iterator[Thread]:
    """Yield a thread, and one per worker whose passes it recorded."""
    events = np.frombuffer(thread.events, EVENT)
    is_pass = events["kind"] == Kind.PASS
    yield Thread(thread.tid, thread.name, events[~is_pass], thread.lost)
    passes = events[is_pass]
    for own in split_by(passes["endpoint"]):
        worker = int(passes["endpoint"][own[0]])
        yield Thread(-1 - worker, f"NDT worker {worker}", passes[own], 0)


def _unless_negative(number: int) -> int | None:
    return None if number < 0 else number
