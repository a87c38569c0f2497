# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reports for people and for programs: tables, CSV, JSON, a plot."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from rmw_manycore_py.bench.summary import Result, Verdict


@dataclass(frozen=True)
class Report:
    """Everything one call of a bench has found."""

    machine: dict[str, str]
    placements: dict[str, str]
    results: Sequence[Result]
    verdicts: Sequence[Verdict]

    def as_json(self) -> str:
        """Return the report without the single samples."""
        return json.dumps(
            {
                "machine": self.machine,
                "placements": self.placements,
                "results": [_row(result) for result in self.results],
                "goals": [
                    {**asdict(verdict.goal), "found": verdict.found, "reached": verdict.reached}
                    for verdict in self.verdicts
                ],
            },
            indent=2,
        )

    def print(self, console: Console) -> None:
        """Print the machine, the measurements and the goals."""
        for name, value in {**self.machine, **self.placements}.items():
            console.print(f"[dim]{name}:[/] {value}", highlight=False)
        console.print(_results_table(self.results))
        if self.verdicts:
            console.print(_goals_table(self.verdicts))

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
    """Write rows that all have the keys of the first."""
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]) if rows else [])
        writer.writeheader()
        writer.writerows(rows)


def _row(result: Result) -> dict[str, Any]:
    names = {"question": result.question, "contender": result.contender, "unit": result.unit}
    return {**names, **asdict(result.summary)}


def _results_table(results: Sequence[Result]) -> Table:
    table = Table("question", "contender", "unit", title="Measurements")
    for name in ("samples", "median", "mean", "p99"):
        table.add_column(name, justify="right")
    previous = ""
    for result in results:
        if result.question != previous:
            table.add_section()
        summary = result.summary
        numbers = [number(value) for value in (summary.median, summary.mean, summary.p99)]
        table.add_row(
            result.question if result.question != previous else "",
            result.contender,
            result.unit,
            str(summary.samples),
            *numbers,
        )
        previous = result.question
    return table


def _goals_table(verdicts: Sequence[Verdict]) -> Table:
    table = Table("question", "contender", "goal", title="Goals")
    table.add_column("found", justify="right")
    table.add_column("")
    for verdict in verdicts:
        table.add_row(
            verdict.goal.question,
            verdict.goal.contender,
            in_words(verdict),
            number(verdict.found),
            "[green]reached[/]" if verdict.reached else "[red]missed[/]",
        )
    return table


def in_words(verdict: Verdict) -> str:
    """Return a goal as a person would say it."""
    goal = verdict.goal
    statistic = "" if goal.statistic == "median" else f" ({goal.statistic})"
    if goal.kind == "better":
        return f">= {goal.factor:g} x better than {goal.peer}{statistic}"
    against = f" x {goal.peer}" if goal.peer else ""
    return f"<= {goal.factor:g}{against}{statistic}"


def number(value: float) -> str:
    """Return a number with about three digits that matter, and thousands marked."""
    if value == 0 or value >= 100:
        return f"{value:,.0f}"
    return f"{value:.1f}" if value >= 10 else f"{value:.2f}"
