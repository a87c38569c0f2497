# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What threads and endpoints cost each other as they become many."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from rmw_manycore_py.bench.contenders import BETWEEN, FAST_DDS, INSIDE, Middleware
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Curve, Goal, Result

SLEEPS = "sleeps of a process per message to one of its threads"
CPU = "CPU time of a process per message to one of its threads"
CREATE = "creating a subscription"
BESIDE = "creating a publisher of another topic meanwhile"
PUBLISH = "publishing to a topic with as many publishers"

THREADS = (1, 8, 32, 63, 128)
ENDPOINTS = (25, 50, 100, 200, 400, 800)
# Fast DDS matches each pair by messages of its own: more take minutes.
MOST_ENDPOINTS_OF_FAST_DDS = 50
QUICK_SHARE = 0.1  # of a run: then only the smaller half of each curve is drawn

MESSAGES = 200
RATE_HZ = 200
FULL, ROOM = "queues full", "with room"
DEPTHS = {FULL: 1, ROOM: 1000}


def measure(run: Run) -> list[Result]:
    """Return the curves over threads of a process, and over endpoints of a topic."""
    results: list[Result] = []
    for middleware in (INSIDE, BETWEEN, FAST_DDS):
        for threads in _drawn(run, THREADS):
            if run.wants(f"{SLEEPS}: {middleware.name}"):
                run.note(f"{threads} threads: {middleware.name}")
                results += _compose(run, middleware, threads)
    for middleware in (INSIDE, FAST_DDS):
        most = ENDPOINTS[-1] if middleware.is_manycore else MOST_ENDPOINTS_OF_FAST_DDS
        for count in _drawn(run, (count for count in ENDPOINTS if count <= most)):
            if run.wants(f"{PUBLISH}: {middleware.name}"):
                run.note(f"{count} publishers and {count} subscriptions: {middleware.name}")
                results += _match(run, middleware, count)
    return results


def _drawn(run: Run, curve: Iterable[int]) -> Sequence[int]:
    counts = tuple(curve)
    return counts[: len(counts) // 2] if run.share <= QUICK_SHARE else counts


def _compose(run: Run, middleware: Middleware, threads: int) -> list[Result]:
    messages = run.iterations(MESSAGES)
    with Session(middleware, run.cpus) as session:
        sink = session.native("composition", 1, role="sink", threads=threads, messages=messages)
        sink.wait_until_ready()
        source = session.native(
            "composition", 0, role="source", threads=threads, messages=messages, rate_hz=RATE_HZ
        )
        source.finish()
        found = sink.finish()
    counted = messages - 1  # from the first to the last
    return [
        _result(question, middleware.name, threads, "threads", unit, [found[key] / counted / scale])
        for question, key, unit, scale in (
            (SLEEPS, "sleeps", "count", 1),
            (CPU, "cpu_ns", "us", 1e3),
        )
    ]


def _match(run: Run, middleware: Middleware, count: int) -> list[Result]:
    def samples_us(measure: str, depth: int) -> list[float]:
        with Session(middleware, run.cpus) as session:
            found = session.native(
                "matches",
                0,
                endpoints=count,
                iterations=run.iterations(MESSAGES),
                measure=measure,
                depth=depth,
            ).finish()
        return [sample / 1e3 for sample in found["samples_ns"]]

    name = middleware.name
    return [
        _result(CREATE, name, count, "endpoints", "us", samples_us("create", 1)),
        _result(BESIDE, name, count, "endpoints", "us", samples_us("beside", 1)),
        *(
            _result(
                PUBLISH, f"{name}, {fill}", count, "endpoints", "us", samples_us("publish", depth)
            )
            for fill, depth in DEPTHS.items()
        ),
    ]


def _result(
    question: str, curve: str, at: int, axis: str, unit: str, samples: Sequence[float]
) -> Result:
    result = Result(question, at_count(curve, at, axis), unit, tuple(samples))
    return replace(result, curve=Curve(curve, at, axis))


def at_count(curve: str, at: int, axis: str) -> str:
    """Return the contender's name at one place of its curve."""
    return f"{curve}, {at} {axis}"


QUESTION = Question(
    "scale",
    measure,
    (
        *(
            Goal(SLEEPS, at_count(middleware.name, threads, "threads"), "within", 2)
            for middleware in (INSIDE, BETWEEN)
            for threads in THREADS
        ),
        *(
            Goal(
                PUBLISH,
                at_count(f"{INSIDE.name}, {FULL}", count, "endpoints"),
                "within",
                2,
                at_count(f"{INSIDE.name}, {ROOM}", count, "endpoints"),
            )
            for count in ENDPOINTS
        ),
    ),
    "threads: source on the first CPU, the process with the threads on the second; "
    "endpoints: all in one process on the first",
)
