#!/usr/bin/env python3
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fills the table of figures in docs/reference/benchmarks/scale_figures.md.

    python scripts/scale_figures.py REPORT docs/reference/benchmarks/scale_figures.md

A row per goal, at the largest number of each curve. A goal that the report lacks has no figures.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

from rmw_manycore_py.bench.contenders import FAST_DDS
from rmw_manycore_py.bench.scale import QUESTION
from rmw_manycore_py.bench.summary import Goal
from rmw_manycore_py.cli.bench.report import number

BEGIN, END = "<!-- figures -->\n", "<!-- end of figures -->\n"
HEAD = "| question | at | goal | rmw_manycore | Fast DDS |\n|---|---|---|---|---|\n"
_PLACE = re.compile(r"(?P<curve>.*), (?P<at>\d+) (?P<axis>[a-z ]+)")


def table(results: list[dict[str, Any]]) -> str:
    """Return the rows, with the figures of these results."""
    goals = {(goal.question, _parts(goal.contender)["curve"]): goal for goal in QUESTION.goals}
    rows = [" | ".join(_row(goal, results)) for goal in goals.values()]
    return HEAD + "".join(f"| {row} |\n" for row in rows)


def _row(goal: Goal, results: list[dict[str, Any]]) -> tuple[str, str, str, str, str]:
    asked = [row for row in results if row["question"] == goal.question]
    own = [row for row in asked if row["contender"] == goal.contender]
    at = goal.contender.replace("manycore ", "", 1)
    figures = _median(own), _median(_rows_of_peer(goal, asked))
    return (goal.question, at, _goal_in_words(goal), *figures)


def _rows_of_peer(goal: Goal, asked: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the row of Fast DDS at its largest number."""
    variant = _parts(goal.contender)["curve"].partition(", ")[2]
    is_own = goal.peer is None or FAST_DDS.name not in goal.peer
    suffix = f", {variant}" if variant else ""
    curve = FAST_DDS.name + suffix if is_own else _parts(goal.peer or "")["curve"]
    rows = [row for row in asked if row["curve"] == curve]
    return sorted(rows, key=lambda row: int(row["at"]))[-1:]


def _median(rows: list[dict[str, Any]]) -> str:
    return "; ".join(f"{number(row['median'])} {row['unit']} ({row['at']})" for row in rows)


def _goal_in_words(goal: Goal) -> str:
    if goal.kind == "better":
        return "better than Fast DDS"
    if goal.peer is None:
        return f"at most {goal.factor:g}"
    own, peer = _parts(goal.contender), _parts(goal.peer)
    variant = peer["curve"].partition(", ")[2] or "with nothing beside"
    other = f"at {peer['at']} {peer['axis']}" if own["at"] != peer["at"] else variant
    return f"at most {goal.factor:g} times that {other}"


def _parts(contender: str) -> dict[str, str]:
    match = _PLACE.fullmatch(contender)
    assert match, contender
    return match.groupdict()


def filled(page: str, results: list[dict[str, Any]]) -> str:
    """Return the page with the table of these results."""
    before, _, rest = page.partition(BEGIN)
    return f"{before}{BEGIN}\n{table(results)}\n{END}{rest.partition(END)[2]}"


def main() -> None:
    """Rewrite the page."""
    report, page = map(Path, sys.argv[1:])
    page.write_text(filled(page.read_text(), json.loads(report.read_text())["results"]))


if __name__ == "__main__":
    main()
