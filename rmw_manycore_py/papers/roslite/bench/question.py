# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The evaluations as one question."""

from __future__ import annotations

from collections.abc import Sequence

from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.relations import Relation, measured_relations
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.papers.roslite.bench import end_to_end, memory, sending, split
from rmw_manycore_py.papers.roslite.bench.claims import CLAIMS
from rmw_manycore_py.papers.roslite.bench.figures import draw


def _measure(run: Run) -> list[Result]:
    parts = (end_to_end, split, sending, memory)
    return [result for part in parts for result in part.measure(run)]


def _relations(results: Sequence[Result]) -> list[Relation]:
    medians = {(r.question, r.contender): r.summary.median for r in results}
    return measured_relations(CLAIMS, medians)


QUESTION = Question(
    "ros-lite",
    _measure,
    (*end_to_end.GOALS, *memory.GOALS),
    "the cores of ros_lite.map and ros_lite_before.yaml on all CPUs in turn",
    _relations,
    draw,
)
