# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Ages of messages on many topics through our Python API, beside that of iceoryx2."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from rmw_manycore_py.bench.contenders import INSIDE, Middleware
from rmw_manycore_py.bench.lent import ICEORYX, has_iceoryx
from rmw_manycore_py.bench.question import Measure, Question, Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result, nearest_rank

TOPICS = 200
SUBSCRIBERS = 2
RATE_HZ = 100
BYTES = 64
FULL_MESSAGES = 1000  # of each topic
SHARE = 0.999
NAME = f"age on {TOPICS} topics with {SUBSCRIBERS} subscribers at {RATE_HZ} Hz"
TAIL = f"{NAME}, p99.9"
OURS = INSIDE.name
THEIRS = f"{ICEORYX} (block)"


def measure(run: Run) -> list[Result]:
    """Measure the ages, and their p99.9 in each round."""
    tails: dict[str, list[float]] = {}

    def listen(middleware: Middleware, kind: str) -> Sequence[float]:
        samples = _ages_us(run, middleware, kind)
        tails.setdefault(middleware.name, []).append(nearest_rank(sorted(samples), SHARE))
        return samples

    contenders: dict[str, Measure] = {OURS: partial(listen, INSIDE, "manycore")}
    if has_iceoryx(run, NAME):
        theirs = Middleware(THEIRS, INSIDE.variables)
        contenders[THEIRS] = partial(listen, theirs, THEIRS)
    ages = run.interleave(NAME, "us", contenders)
    return ages + [Result(TAIL, name, "us", tuple(found)) for name, found in tails.items()]


def _ages_us(run: Run, middleware: Middleware, kind: str) -> Sequence[float]:
    with Session(middleware, run.cpus) as session:
        messages = run.iterations(FULL_MESSAGES)
        source = session.python("topics", 0, "source", kind, TOPICS, BYTES, RATE_HZ, messages)
        source.wait_until_ready()
        sinks = [
            session.python("topics", party, "sink", kind, TOPICS)
            for party in range(1, SUBSCRIBERS + 1)
        ]
        for sink in sinks:
            sink.wait_until_ready()
        source.release()
        source.finish()
        return in_us([age_ns for sink in sinks for age_ns in sink.finish()["samples_ns"]])


QUESTION = Question(
    "many topics",
    measure,
    (Goal(TAIL, OURS, "better", 1.0, THEIRS),),
    "source and second subscriber on the first CPU, first subscriber on the second",
)
