# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fig. 14 and 16: the localizer and the whole pipeline, before and after parallelization."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.papers.roslite.bench.drives import drive, nothing
from rmw_manycore_py.papers.roslite.variants import AFTER as AFTER_MAP
from rmw_manycore_py.papers.roslite.variants import BEFORE as BEFORE_MAP
from rmw_manycore_py.papers.roslite.variants import installed
from rmw_manycore_py.papers.roslite.vehicle.drive_log import DriveFigures

BEFORE, AFTER = "before: four cores", "after: a cluster per node"
MAPFILES = {BEFORE: BEFORE_MAP, AFTER: AFTER_MAP}
SCANS = 1000  # of all rounds together

COMMAND, PLAN = "scan to command", "scan to planned lane"
ALIGNMENT, PASSES, LATE = "lidar_localizer", "passes of an alignment", "scans late or lost"
LATERAL = "distance from the lane"
FIGURES: dict[str, tuple[str, Callable[[DriveFigures], Sequence[float]]]] = {
    COMMAND: ("ms", lambda found: found.to_command_ms),
    PLAN: ("ms", lambda found: found.to_plan_ms),
    ALIGNMENT: ("ms", lambda found: found.alignment_ms),
    PASSES: ("", lambda found: found.passes),
    LATERAL: ("m", lambda found: found.lateral_m),
}
GOALS = (Goal(LATE, AFTER, "within", 0.0, statistic="largest"),)


def measure(run: Run) -> list[Result]:
    """Drive with both mapfiles in turns."""
    contenders = [name for name in MAPFILES if run.wants(f"drive: {name}")]
    found: dict[str, list[DriveFigures]] = {name: [] for name in contenders}
    for turn in range(run.rounds):
        for name in contenders:
            run.note(f"drive, round {turn + 1} of {run.rounds}: {name}")
            try:
                scans = max(run.iterations(SCANS) // run.rounds, 1)
                figures, _ = drive(installed(MAPFILES[name]), scans, meanwhile=nothing)
            except ManycoreError as error:
                run.failures.append(f"drive: {name}: {error}")
                continue
            found[name].append(figures)
    results = [
        Result(question, name, unit, samples)
        for question, (unit, samples_of) in FIGURES.items()
        for name, drives in found.items()
        if (samples := tuple(float(value) for one in drives for value in samples_of(one)))
    ]
    return results + [
        Result(LATE, name, f"of {sum(one.scans for one in drives)}", (_late(drives),))
        for name, drives in found.items()
        if drives
    ]


def _late(drives: Sequence[DriveFigures]) -> float:
    return float(sum(one.late for one in drives))
