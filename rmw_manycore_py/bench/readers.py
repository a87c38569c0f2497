# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""CPU time of eight readers in rclpy that take one large message, all together."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rmw_manycore_py.bench.contenders import FAST_DDS, TUNED_FAST_DDS, Middleware
from rmw_manycore_py.bench.copies import READ_ONLY, WITH, WITHOUT
from rmw_manycore_py.bench.question import PAYLOADS, Question, Run, for_each
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

READERS = 8
SIZE = "8 MiB"
FULL_MESSAGES = 20
WARM_UP = 3
NAME = f"CPU time of {READERS} takes of {SIZE}"
COPY = "one copy"
MIDDLEWARES = (READ_ONLY, WITHOUT, WITH, FAST_DDS, TUNED_FAST_DDS)


def measure(run: Run) -> list[Result]:
    """Measure the takes of all readers together, message by message."""
    messages = WARM_UP + run.iterations(FULL_MESSAGES)
    copies_us: list[float] = []

    def take(middleware: Middleware) -> Sequence[float]:
        with Session(middleware, run.cpus) as session:
            readers = [
                session.python("readers", party, "reader", messages) for party in range(READERS)
            ]
            source = session.python("readers", 0, "source", PAYLOADS[SIZE], messages, READERS)
            found = [in_us(reader.finish()["samples_ns"]) for reader in readers]
            copies_us.extend(in_us(source.finish()["copies_ns"])[WARM_UP:])
        return [math.fsum(each) for each in zip(*found, strict=True)][WARM_UP:]

    results = run.interleave(NAME, "us", for_each(MIDDLEWARES, take))
    return results + ([Result(NAME, COPY, "us", tuple(copies_us))] if copies_us else [])


QUESTION = Question(
    "readers",
    measure,
    (
        Goal(NAME, READ_ONLY.name, "within", 1.0, COPY),
        Goal(NAME, WITHOUT.name, "within", READERS, COPY),
    ),
    "publisher on the first CPU, readers on both in turn",
)
