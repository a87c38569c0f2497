# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs the reference system: all figures of all setups, alternating contenders."""

from __future__ import annotations

import os
from pathlib import Path

from rmw_manycore_py.bench.load import busy
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.session import TIMEOUT_S
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.papers.reference_system.bench.goals import goals, question
from rmw_manycore_py.papers.reference_system.bench.setups import Contender, Setup, Wanted, setups
from rmw_manycore_py.papers.reference_system.bench.system import Found, run_system

MIN_DURATION_S = 4.0


def reference_question(wanted: Wanted, texts: Path | None) -> Question:
    """Return the question; writes the output of the command node to `texts`, if given."""

    def measure(run: Run) -> list[Result]:
        return [r for setup in setups(wanted) for r in _take_turns(run, wanted, setup, texts)]

    return Question(
        f"reference system, {wanted.nodes}, {wanted.message}, {wanted.crunch_ms:g} ms",
        measure,
        goals(wanted),
        "as in the mapfile autoware_reference; the load beside is on the last CPU",
    )


def _take_turns(run: Run, wanted: Wanted, setup: Setup, texts: Path | None) -> list[Result]:
    collected: dict[tuple[str, str], Result] = {}
    contenders = {n: c for n, c in setup.contenders.items() if run.wants(f"{setup.name}: {n}")}
    for turn in range(run.rounds):
        for name, contender in tuple(contenders.items()):
            run.note(f"{setup.name}, round {turn + 1} of {run.rounds}: {name}")
            try:
                found = _run(run, wanted, setup, contender)
            except ManycoreError as error:
                run.failures.append(f"{setup.name}: {name}: {error}")
                del contenders[name]
                continue
            for kpi in setup.figures(found):
                asked = question(kpi.name, setup.name)
                before = collected.get((asked, name))
                samples = (*(before.samples if before else ()), *kpi.samples)
                collected[asked, name] = Result(
                    asked, name, kpi.unit, samples, kpi.higher_is_better
                )
            if texts:
                _save(texts, wanted, setup, contender, name, found)
    return list(collected.values())


def _run(run: Run, wanted: Wanted, setup: Setup, contender: Contender) -> Found:
    duration_s = max(setup.duration_s * run.share, MIN_DURATION_S)
    last_cpu = max(os.sched_getaffinity(0))
    with busy(int(setup.is_beside_a_load), [last_cpu], TIMEOUT_S + duration_s):
        return run_system(
            wanted.nodes, contender.middleware, contender.system, setup.load, duration_s
        )


def _save(
    texts: Path, wanted: Wanted, setup: Setup, contender: Contender, name: str, found: Found
) -> None:
    """Write the output in the place and format that upstream's report scripts expect."""
    rmw = contender.middleware.variables["RMW_IMPLEMENTATION"]
    run_name = f"{name}, {wanted.nodes}, {wanted.message}, {setup.name}".replace(" ", "_")
    directory = texts / f"{round(found.window_s)}s" / rmw / run_name
    directory.mkdir(parents=True, exist_ok=True)
    text = f"RMW Implementation: {rmw}\n{found.text}"
    (directory / "std_output.log").write_text(text)
