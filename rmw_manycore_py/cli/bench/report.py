# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bench reports: tables, CSV, JSON and a plot."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from rich.table import Table
from rich.text import Text

from rmw_manycore_py.bench.relations import Relation
from rmw_manycore_py.bench.summary import SPREAD, Result, Verdict, nearest_rank
from rmw_manycore_py.cli.common.printing import echo, new_table, print_table


@dataclass(frozen=True)
class Report:
    """Results of one run of a bench."""

    machine: dict[str, str]
    placements: dict[str, str]
    results: Sequence[Result]
    verdicts: Sequence[Verdict]
    failures: Sequence[str]  # contenders that could not be measured, and why
    relations: Sequence[Relation] = ()

    def as_json(self) -> str:
        """Return the report as JSON, without individual samples."""
        return json.dumps(
            {
                "machine": self.machine,
                "placements": self.placements,
                "results": [_row(result) for result in self.results],
                "goals": [
                    {**asdict(verdict.goal), "found": verdict.found, "reached": verdict.reached}
                    for verdict in self.verdicts
                ],
                "failures": list(self.failures),
                "relations": [asdict(relation) for relation in self.relations],
            },
            indent=2,
        )

    def print(self) -> None:
        """Print the machine, the measurements and the goals."""
        for name, value in {**self.machine, **self.placements}.items():
            echo(f"{name}: {value}")
        echo()
        print_table(_results_table(self.results))
        if self.verdicts:
            echo()
            print_table(_goals_table(self.verdicts))
        if self.relations:
            echo()
            print_table(_relations_table(self.relations))

    def write(self, directory: Path) -> list[Path]:
        """Write report.json, results.csv and samples.csv; return their paths."""
        directory.mkdir(parents=True, exist_ok=True)
        report = directory / "report.json"
        report.write_text(self.as_json() + "\n")
        results = directory / "results.csv"
        write_csv(results, [_row(result) for result in self.results])
        samples = directory / "samples.csv"
        write_csv(
            samples,
            [
                {"question": r.question, "contender": r.contender, "unit": r.unit, "sample": sample}
                for r in self.results
                for sample in r.samples
            ],
        )
        return [report, results, samples]


def write_csv(path: Path, rows: Sequence[dict[str, Any]]) -> None:
    """Write rows as CSV; all of them have the keys of the first."""
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]) if rows else [])
        writer.writeheader()
        writer.writerows(rows)


def _row(result: Result) -> dict[str, Any]:
    names = {"question": result.question, "contender": result.contender, "unit": result.unit}
    curve = {
        "curve": result.curve.name if result.curve else "",
        "at": result.curve.at if result.curve else "",
        "axis": result.curve.axis if result.curve else "",
    }
    spread = {f"p{100 * share:g}": nearest_rank(sorted(result.samples), share) for share in SPREAD}
    return {**names, **curve, **asdict(result.summary), **spread}


def _results_table(results: Sequence[Result]) -> Table:
    table = new_table("question", "contender", "#median", "#mean", "#p99", "unit", "#samples")
    previous = ""
    for result in sorted(results, key=_order_of(results)):
        if previous not in ("", result.question):
            table.add_row()
        summary = result.summary
        table.add_row(
            "" if result.question == previous else result.question,
            result.contender,
            *(number(value) for value in (summary.median, summary.mean, summary.p99)),
            result.unit,
            str(summary.samples),
        )
        previous = result.question
    return table


def _order_of(results: Sequence[Result]) -> Callable[[Result], int]:
    """Return a sort key that orders results by question, in order of first appearance."""
    questions = list(dict.fromkeys(result.question for result in results))
    return lambda result: questions.index(result.question)


def _goals_table(verdicts: Sequence[Verdict]) -> Table:
    table = new_table("question", "contender", "goal", "#found", "")
    for verdict in verdicts:
        table.add_row(
            verdict.goal.question,
            verdict.goal.contender,
            in_words(verdict),
            number(verdict.found),
            Text("reached", "green") if verdict.reached else Text("missed", "red"),
        )
    return table


def _relations_table(relations: Sequence[Relation]) -> Table:
    table = new_table("relation", "in the paper", "found", "", "basis")
    for relation in relations:
        held = Text(relation.in_words, "green" if relation.holds else "red")
        table.add_row(relation.name, relation.statement, relation.found, held, relation.basis)
    return table


def in_words(verdict: Verdict) -> str:
    """Return a goal in words."""
    goal = verdict.goal
    statistic = "" if goal.statistic == "median" else f" ({goal.statistic})"
    if goal.kind == "better" and goal.peer is None:
        return f">= {goal.factor:g}{statistic}"
    if goal.kind == "better":
        return f">= {goal.factor:g} x better than {goal.peer}{statistic}"
    against = f" x {goal.peer}" if goal.peer else ""
    return f"<= {goal.factor:g}{against}{statistic}"


def number(value: float) -> str:
    """Format a number with about three significant digits and thousands separators."""
    if value == 0 or value >= 100:
        return f"{value:,.0f}"
    return f"{value:.1f}" if value >= 10 else f"{value:.2f}"
