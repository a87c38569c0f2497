# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The products on this machine: pinned worker processes, and tiles copied between segments.

| the thesis | here |
|---|---|
| IO DDR | matrices that were flushed from all caches |
| IO SMEM, CC SMEM | matrices that are in the caches |
| uncached | each row of B is flushed after use: user space has no uncached memory |
| off-load | tiles are copied into four segments, multiplied there, and C is copied back |
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from rmw_manycore_py.bench.question import Measure, Question, Run
from rmw_manycore_py.bench.relations import Relation, measured_relations
from rmw_manycore_py.bench.session import TIMEOUT_S, run_program
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.papers.thesis.matrix.cases import (
    IO_DDR,
    IO_SMEM,
    LOST,
    OFFLOAD,
    RUNS,
    SMALL,
    Case,
    Place,
)
from rmw_manycore_py.papers.thesis.matrix.claims import CLAIMS
from rmw_manycore_py.papers.thesis.matrix.figures import Draw
from rmw_manycore_py.platform.topology import usable_cpus

WARM_UP = 2
QUICK_RUNS = RUNS // 4  # before they are cut further: some products take a second uncached
CHECKSUMS = "different results for other splits"
OURS = "all splits"
COPIES = "copies of an off-loaded product"


@dataclass(frozen=True)
class _MeasuredTimes:
    sizes: tuple[int, ...]
    free_cores: int
    medians: Mapping[tuple[str, str], float]

    def ms(self, case: Case) -> float:
        return self.medians[case.question, case.name]

    def lost(self, place: Place) -> float:
        return self.medians[LOST, f"to {place}"]


@dataclass
class _Seen:
    """Checksums of C by size, and how long copies took, while contenders take turns."""

    checksums: dict[int, set[int]] = field(default_factory=dict)
    offloaded: dict[int, set[int]] = field(default_factory=dict)
    copy_ms: dict[Case, list[float]] = field(default_factory=dict)


def question(cases: Sequence[Case], draw: Draw) -> Question:
    """Return the question as it is put to this machine."""
    sizes = tuple(sorted({case.n for case in cases}))

    def measure(run: Run) -> list[Result]:
        seen = _Seen()
        results = []
        for name in dict.fromkeys(case.question for case in cases):
            asked = {case.name: case for case in cases if case.question == name}
            contenders = {key: _measure(run, case, seen) for key, case in asked.items()}
            results += [
                replace(result, curve=asked[result.contender].curve)
                for result in run.interleave(name, "ms", contenders)
            ]
        lost = run.interleave(LOST, "products", _losses(run, sizes[0]))
        return [*results, *_from(seen), *lost]

    def relations(results: Sequence[Result]) -> list[Relation]:
        medians = {(r.question, r.contender): r.summary.median for r in results}
        times = _MeasuredTimes(sizes, len(usable_cpus()), medians)
        return measured_relations(CLAIMS, times)

    goals = (Goal(CHECKSUMS, OURS, "within", 0, statistic="largest"),)
    return Question(
        "matrix", measure, goals, "workers on the usable CPUs in turns", relations, draw
    )


def _measure(run: Run, case: Case, seen: _Seen) -> Measure:
    def measure() -> list[float]:
        found = _multiply(run, case)
        sums = seen.offloaded if case.place == OFFLOAD else seen.checksums
        sums.setdefault(case.n, set()).add(found["checksum"])
        if case.place == OFFLOAD:
            seen.copy_ms.setdefault(case, []).append(found["copy_ns"] / 1e6)
        return [sample_ns / 1e6 for sample_ns in found["samples_ns"]]

    return measure


def _losses(run: Run, n: int) -> dict[str, Measure]:
    """Return what compares off-loaded products, collected in each memory, with one in one place."""

    def wrong(place: Place) -> list[float]:
        alone = _multiply(run, Case(n, IO_DDR, True, 1))
        found = _multiply(run, Case(n, OFFLOAD, False, 1), place)
        return [float(found["checksum"] != alone["checksum"])]

    return {f"to {IO_DDR}": lambda: wrong(IO_DDR), f"to {IO_SMEM}": lambda: wrong(IO_SMEM)}


def _multiply(run: Run, case: Case, place: Place | None = None) -> dict[str, Any]:
    """Run a case; `place` is where the matrices of an off-loaded one are, by default in DDR."""
    of_matrices = place or (IO_DDR if case.place == OFFLOAD else case.place)
    return run_program(
        "matrix_product",
        timeout_s=TIMEOUT_S * max(1, (case.n / SMALL) ** 3),
        n=case.n,
        threads=case.threads,
        clusters=4 if case.place == OFFLOAD else 0,
        memory="ddr" if of_matrices == IO_DDR else "smem",
        evicted=int(not case.is_cached and case.place != OFFLOAD),
        cpus=",".join(map(str, usable_cpus())),
        warm_up=WARM_UP,
        iterations=run.iterations(RUNS if run.share == 1 else QUICK_RUNS),
    )


def _from(seen: _Seen) -> list[Result]:
    """Return what the runs showed beside their times."""
    sums = [seen.checksums.get(n, set()) | s for n, s in seen.offloaded.items()]
    sums += [s for n, s in seen.checksums.items() if n not in seen.offloaded]
    different = float(sum(len(found) - 1 for found in sums))
    results = [Result(CHECKSUMS, OURS, "count", (different,))] if sums else []
    for case, copies in seen.copy_ms.items():
        name = f"{case.n} x {case.n}, {case.name}"
        results.append(Result(COPIES, name, "ms", tuple(copies)))
    return results
