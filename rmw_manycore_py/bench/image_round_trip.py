# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Round trips of images through rclpy that numpy reads at both ends."""

from __future__ import annotations

import statistics
from collections.abc import Sequence

from rmw_manycore_py.bench.contenders import FAST_DDS, MIB, TUNED_FAST_DDS, Middleware
from rmw_manycore_py.bench.question import PAYLOADS, Question, Run, for_each
from rmw_manycore_py.bench.rclpy_round_trip import RUN_INSIDE
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

SIZES = ("1 MiB", "8 MiB")
SMALL = PAYLOADS["64 B"]
WARM_UP = 20
MIDDLEWARES = (RUN_INSIDE, FAST_DDS, TUNED_FAST_DDS)
FLOOR = "64 B, 2 copies and 2 reads"


def measure(run: Run) -> list[Result]:
    """Measure all sizes in sequence."""
    results = []
    for size in SIZES:
        size_bytes = PAYLOADS[size]
        count = run.iterations(200 if size_bytes == MIB else 50)

        def talk(
            middleware: Middleware, size_bytes: int = size_bytes, n: int = count
        ) -> list[float]:
            return in_us(_ping(run, middleware, size_bytes, n)["samples_ns"])

        def floor(size_bytes: int = size_bytes, n: int = count) -> Sequence[float]:
            small = in_us(_ping(run, RUN_INSIDE, SMALL, n)["samples_ns"])
            found = _ping(run, RUN_INSIDE, size_bytes, n)
            copy, read = (statistics.median(in_us(found[k])) for k in ("copy_ns", "read_ns"))
            return [sample + 2 * copy + 2 * read for sample in small]

        contenders = {FLOOR: floor, **for_each(MIDDLEWARES, talk)}
        results += run.interleave(_question(size), "us", contenders)
    return results


def _ping(run: Run, middleware: Middleware, size_bytes: int, count: int) -> dict[str, list[int]]:
    with Session(middleware, run.cpus) as session:
        pong = session.python("images", 1, "pong", size_bytes)
        ping = session.python("images", 0, "ping", size_bytes, WARM_UP, count)
        found = ping.finish()
        pong.finish()
    return found


def _question(size: str) -> str:
    return f"rclpy round trip of an image of {size}, read by numpy"


QUESTION = Question(
    "image round trip",
    measure,
    tuple(
        goal
        for size in SIZES
        for goal in (
            Goal(_question(size), RUN_INSIDE.name, "within", 1.1, FLOOR),
            Goal(_question(size), RUN_INSIDE.name, "better", 2.0, TUNED_FAST_DDS.name),
        )
    ),
    "ping on the first CPU, pong on the second",
)
