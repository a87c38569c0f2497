# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Round trips through our Python API in lent room, beside the Python binding of iceoryx2."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from rmw_manycore_py.bench.contenders import INSIDE, Middleware, manycore
from rmw_manycore_py.bench.question import PAYLOADS, Measure, Question, Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.errors.missing_library import ICEORYX2, missing

SIZES = ("64 B", "64 KiB", "1 MiB", "8 MiB")
WARM_UP = 100
FULL_ITERATIONS = 2000
ICEORYX = "iceoryx2"
ASLEEP, SPINNING = "Python API round trip, asleep", "Python API round trip, spinning"
QUESTIONS = {ASLEEP: "block", SPINNING: "spin"}


def has_iceoryx(run: Run, question: str) -> bool:
    """Return whether iceoryx2 is installed; note it otherwise."""
    if text := missing(ICEORYX2):
        run.note(f"{question}: {text}")
    return not text


def measure(run: Run) -> list[Result]:
    """Measure all sizes, asleep and spinning."""
    results = []
    for question, wait in QUESTIONS.items():
        ours = manycore("inside", "spin" if wait == "spin" else "block")
        theirs = Middleware(f"{ICEORYX} ({wait})", INSIDE.variables)
        contenders: dict[str, Measure] = {}
        for size in SIZES:
            contenders[f"{ours.name}, {size}"] = partial(_talk, run, ours, "manycore", size)
            if has_iceoryx(run, question):
                name = f"{theirs.name}, {size}"
                contenders[name] = partial(_talk, run, theirs, theirs.name, size)
        results += run.interleave(question, "us", contenders)
    return results


def _talk(run: Run, middleware: Middleware, kind: str, size: str) -> Sequence[float]:
    iterations = run.iterations(FULL_ITERATIONS)
    with Session(middleware, run.cpus) as session:
        pong = session.python("lent", 1, "pong", kind, PAYLOADS[size])
        ping = session.python("lent", 0, "ping", kind, PAYLOADS[size], WARM_UP, iterations)
        pong.wait_until_ready()
        ping.wait_until_ready()
        ping.release()
        samples = in_us(ping.finish()["samples_ns"])
        pong.release()
        pong.finish()
    return samples


def _goals() -> tuple[Goal, ...]:
    goals = []
    for question, wait in QUESTIONS.items():
        for size in SIZES:
            name = f"manycore inside ({wait}), {size}"
            if size != SIZES[0]:
                goals.append(
                    Goal(question, name, "within", 1.2, f"manycore inside ({wait}), {SIZES[0]}")
                )
            goals.append(Goal(question, name, "better", 1.0, f"{ICEORYX} ({wait}), {size}"))
    return tuple(goals)


QUESTION = Question("lent", measure, _goals(), "ping on the first CPU, pong on the second")
