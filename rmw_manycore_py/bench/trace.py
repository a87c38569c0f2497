# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cost of tracing: a trace site, a round trip, and saving."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rmw_manycore_py.bench.contenders import INSIDE
from rmw_manycore_py.bench.question import PAYLOADS, Question, Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.native import _transport
from rmw_manycore_py.trace.events import EVENT, Endpoint, Kind, Process, Thread, Trace
from rmw_manycore_py.trace.files import save

SIZE = "64 B"
WARM_UP = 50
ROUND_TRIPS = 2000
SITE_ROUNDS = 10
EVENTS = 1_000_000
SAVED_AS = (".json", ".csv", ".pftrace")
_OFF, _ON = "not traced", "traced"
_PER_MESSAGE = 8  # events per message


def measure(run: Run) -> list[Result]:
    """Measure trace sites, alternating round trips, and saving a million events."""
    return [
        *_sites(run),
        *run.interleave(
            f"traced round trip {SIZE}",
            "us",
            {_OFF: lambda: _round_trips(run, False), _ON: lambda: _round_trips(run, True)},
        ),
        *_saving(run),
    ]


def _sites(run: Run) -> list[Result]:
    run.note("trace site")
    with Session(INSIDE, run.cpus) as session:
        found = session.native("trace_site", 0, events=EVENTS, rounds=SITE_ROUNDS).finish()
    return [
        Result("trace site", _OFF, "ns", tuple(in_us(found["samples_ns"]))),  # from ps
        Result("trace site", _ON, "ns", (found["on_ps"] / 1e3,)),
        Result("events lost of a million at once", _ON, "count", (found["lost"],)),
    ]


def _round_trips(run: Run, traced: bool) -> Sequence[float]:
    arguments = {"warm_up": WARM_UP, "iterations": run.iterations(ROUND_TRIPS)}
    with (
        Session(INSIDE, run.cpus) as session,
        _transport.Configurator(
            session.platform,
            clusters=5,
            cores_per_cluster=16,
            smem_bytes=0,
            host_cpu_of_receive_thread={},
            topics=[],
        ),
    ):
        if traced:
            _transport.start_trace(session.platform, clusters=(), nodes=(), events=0, discard=False)
        ping = session.native("round_trip", 0, role="ping", bytes=PAYLOADS[SIZE], **arguments)
        pong = session.native("round_trip", 1, role="pong")
        found = ping.finish()
        pong.finish()
    return in_us(found["samples_ns"])


def _saving(run: Run) -> list[Result]:
    trace = million()
    results = []
    with tempfile.TemporaryDirectory() as directory:
        for suffix in SAVED_AS:
            run.note(f"saving a million events: {suffix}")
            start_s = time.perf_counter()
            save(trace, Path(directory, f"trace{suffix}"))
            spent_s = time.perf_counter() - start_s
            results.append(Result("saving a million events", suffix, "s", (spent_s,)))
    return results


def million() -> Trace:
    """Return a trace of a million events, as left by two communicating nodes."""
    count = EVENTS // _PER_MESSAGE
    kinds = (
        (Kind.PUBLISH_BEGIN, Kind.SERIALIZE_BEGIN, Kind.WRITE, Kind.HINT, Kind.PUBLISH_END),
        (Kind.WAIT_END, Kind.CLAIM, Kind.RELEASE),
    )
    threads = []
    for side, row in enumerate(kinds):
        events = np.zeros(count * len(row), EVENT)
        number = np.repeat(np.arange(1, count + 1), len(row))
        step = np.tile(np.arange(len(row)), count)
        events["number"] = number
        events["time_ns"] = number * 10_000 + side * 5_000 + step * 100
        events["endpoint"] = np.where(np.tile(row, count) == Kind.HINT, 1, side)
        events["kind"] = np.tile(row, count)
        threads.append(Thread(side + 1, "bench", events, 0))
    processes = tuple(
        Process(thread.tid, 1, thread.tid, None, "bench", False, False, (thread,), 0)
        for thread in threads
    )
    names = {
        side: Endpoint(side == 0, "topic", "/bench", "std_msgs/msg/String", f"/node_{side}", 1)
        for side in range(2)
    }
    return Trace("bench", processes, names, 0)


QUESTION = Question(
    "trace",
    measure,
    (
        Goal("trace site", _OFF, "within", 2.0),
        Goal("trace site", _ON, "within", 40.0),
        Goal("events lost of a million at once", _ON, "within", 0),
        Goal(f"traced round trip {SIZE}", _ON, "within", 1.03, _OFF),
        *(Goal("saving a million events", suffix, "within", 5.0) for suffix in SAVED_AS),
    ),
    "ping on the first CPU, pong on the second, inside a cluster; a site in a loop of its own",
)
