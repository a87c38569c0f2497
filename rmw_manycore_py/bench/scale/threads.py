# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cost of a message for one thread of a process in which many threads wait."""

from __future__ import annotations

from functools import partial

from rmw_manycore_py.bench.contenders import BETWEEN, FAST_DDS, INSIDE, Middleware, manycore
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.scale.common import along, at_count, on_curve
from rmw_manycore_py.bench.session import Process, Session
from rmw_manycore_py.bench.summary import Goal, Result

SLEEPS = "sleeps of a process per message to one of its threads"
CPU = "CPU time of a process per message to one of its threads"
NOTIFIED = "wake words that a message to one thread of a process notifies"
THREADS = (1, 8, 32, 63, 128)
MESSAGES = 200
RATE_HZ = 200
SPIN = manycore("inside", "spin")
ADAPTIVE = manycore("inside", "adaptive"), manycore("between", "adaptive")
OWN = (INSIDE, BETWEEN, *ADAPTIVE, SPIN)


def measure(run: Run) -> list[Result]:
    """Return voluntary switches, CPU time and notifications per message, over the threads."""
    results: list[Result] = []
    for middleware in (*OWN, FAST_DDS):
        measured = partial(_compose, run, middleware)
        results += along(run, f"{SLEEPS}: {middleware.name}", THREADS, "threads", measured)
    return results


def _compose(run: Run, middleware: Middleware, threads: int) -> list[Result]:
    def found(question: str, unit: str, sample: float) -> Result:
        return on_curve(question, middleware.name, threads, "threads", unit, [sample])

    messages = run.iterations(MESSAGES)
    notified = None
    with Session(middleware, run.cpus) as session:
        sink = session.native("composition", 1, role="sink", threads=threads, messages=messages)
        sink.wait_until_ready()
        watch = _watch(session, sink) if middleware.is_manycore else None
        source = session.native(
            "composition", 0, role="source", threads=threads, messages=messages, rate_hz=RATE_HZ
        )
        source.finish()
        if watch is not None:  # before the sink's end, which notifies all words
            watch.release()
            notified = watch.finish()["notified"]
        spent = sink.finish()
    counted = messages - 1  # intervals from the first to the last
    of_all = messages + 2 * threads  # plus the first and the last message of each thread
    return [
        found(SLEEPS, "count", spent["sleeps"] / counted),
        # A thread that spins uses all the time it gets.
        *([found(CPU, "us", spent["cpu_ns"] / counted / 1e3)] if middleware != SPIN else []),
        *([found(NOTIFIED, "count", notified / of_all)] if notified is not None else []),
    ]


def _watch(session: Session, sink: Process) -> Process:
    """Start counting the notifications of the sink's wake words."""
    watch = session.native("wake_ups", 0, pid=sink.pid)
    watch.wait_until_ready()
    return watch


GOALS = tuple(
    Goal(question, at_count(middleware.name, threads, "threads"), "within", 2)
    for question, middlewares in (
        (SLEEPS, (INSIDE, BETWEEN, *ADAPTIVE)),
        (NOTIFIED, OWN),  # of threads that spin, too, which never sleep
    )
    for middleware in middlewares
    for threads in THREADS
)
PLACEMENT = "threads: source on the first CPU, the process with the threads on the second"
