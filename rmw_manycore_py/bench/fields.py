# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Time to assign a buffer to a field of a message, with fast fields and as generated."""

from __future__ import annotations

import array
import importlib
import time
from collections.abc import Sequence
from types import ModuleType

import numpy as np

from rmw_manycore_fields import fast_array
from rmw_manycore_py.bench.question import PAYLOADS, Question, Run
from rmw_manycore_py.bench.summary import Goal, Result

SIZES = ("64 B", "8 MiB")
FULL_ASSIGNMENTS = 8
REPEATED = {"64 B": 1000, "8 MiB": 1}  # assignments that are timed together
FAST, GENERATED, BYTES = "numpy array", "numpy array, as generated", "bytes, as generated"
VIEW, CONSTRUCTED = "memoryview", "numpy array, constructor"


def measure(run: Run) -> list[Result]:
    """Assign to `Image.data`."""
    results = []
    for size in SIZES:
        values = np.full(PAYLOADS[size], 7, np.uint8)
        contenders = {
            FAST: lambda v=values, s=size: _assign(run, s, v, fast_array()),
            VIEW: lambda v=values, s=size: _assign(run, s, memoryview(v), fast_array()),
            CONSTRUCTED: lambda v=values, s=size: _assign(run, s, v, fast_array(), construct=True),
            GENERATED: lambda v=values, s=size: _assign(run, s, v, array),
            BYTES: lambda v=values, s=size: _assign(run, s, v.tobytes(), array),
        }
        results += run.interleave(_question(size), "us", contenders)
    return results


def _question(size: str) -> str:
    return f"assignment of {size} to a field"


def _assign(
    run: Run, size: str, values: object, module: ModuleType, *, construct: bool = False
) -> Sequence[float]:
    generated = importlib.import_module("sensor_msgs.msg._image")
    found, repeated = generated.array, REPEATED[size]
    generated.array = module  # type: ignore[attr-defined]
    message, samples = generated.Image(), []
    try:
        for _ in range(run.iterations(FULL_ASSIGNMENTS)):
            begin_ns = time.perf_counter_ns()
            for _ in range(repeated):
                if construct:
                    generated.Image(data=values)
                else:
                    message.data = values
            samples.append((time.perf_counter_ns() - begin_ns) / repeated / 1e3)
    finally:
        generated.array = found  # type: ignore[attr-defined]
    return samples


QUESTION = Question(
    "fields",
    measure,
    (
        Goal(_question("64 B"), FAST, "within", 1.0, GENERATED),
        *(Goal(_question("8 MiB"), contender, "within", 1000.0) for contender in (FAST, VIEW)),
        Goal(_question("8 MiB"), FAST, "better", 100.0, GENERATED),
    ),
    "in one process, without a middleware",
)
