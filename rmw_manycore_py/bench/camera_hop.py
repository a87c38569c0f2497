# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A camera of 5 MP at 60 Hz, one hop through rclpy, on a machine that does nothing else."""

from __future__ import annotations

from collections.abc import Sequence

from rmw_manycore_py.bench.cameras import LARGE, MIDDLEWARES, detections
from rmw_manycore_py.bench.contenders import Middleware
from rmw_manycore_py.bench.question import Question, Run, for_each
from rmw_manycore_py.bench.summary import Goal, Result

FULL_IMAGES = 300
CPU = f"{LARGE.name}: CPU time of the reader"
LOST = f"{LARGE.name}: lost"
OURS = MIDDLEWARES[0]


def measure(run: Run) -> list[Result]:
    """Measure the share of a CPU, and the losses."""
    images = run.iterations(FULL_IMAGES)
    lost: dict[str, list[float]] = {}

    def shoot(middleware: Middleware) -> Sequence[float]:
        found = detections(LARGE, middleware, images, with_filter=False)
        lost.setdefault(middleware.name, []).append(images - found.arrived)
        return [100 * found.cpu_s * LARGE.rate_hz / images]

    shares = run.interleave(CPU, "% of a CPU", for_each(MIDDLEWARES, shoot))
    return shares + [Result(LOST, name, "images", tuple(counts)) for name, counts in lost.items()]


QUESTION = Question(
    "camera",
    measure,
    (
        Goal(CPU, OURS.name, "within", 60.0),
        Goal(LOST, OURS.name, "within", 0, statistic="largest"),
    ),
    "camera and reader on either CPU",
)
