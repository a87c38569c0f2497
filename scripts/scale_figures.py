#!/usr/bin/env python3
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fills the table of figures in docs/reference/benchmarks/scale.md.

    python scripts/scale_figures.py REPORT docs/reference/benchmarks/scale.md

A row per goal, at the largest number of its curve, with the largest median of all placements and
ways to wait. A question is written once. A goal that the report lacks has no figures.
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
_PARTY = re.compile(r".*manycore [\w ]+ \(\w+\)(, )?")

Key = tuple[str, str, str]


def table(results: list[dict[str, Any]]) -> str:
    """Return the rows, with the figures of these results."""
    largest = {(goal.question, _parts(goal.contender)["curve"]): goal for goal in QUESTION.goals}
    rows: dict[Key, list[Goal]] = {}
    for goal in largest.values():
        rows.setdefault((goal.question, _at(goal), _goal_in_words(goal)), []).append(goal)
    lines, above = "", ""
    for (question, *place), goals in rows.items():
        shown = "" if question == above else question
        above = question
        lines += f"| {' | '.join((shown, *place, *_figures(goals, results)))} |\n"
    return HEAD + lines


def _at(goal: Goal) -> str:
    """Return the number and the variant of a goal's curve, without its placement."""
    parts = _parts(goal.contender)
    variant = _PARTY.sub("", parts["curve"], count=1)
    return ", ".join(filter(None, (variant, f"{parts['at']} {parts['axis']}")))


def _figures(goals: list[Goal], results: list[dict[str, Any]]) -> tuple[str, str]:
    asked = [row for row in results if row["question"] == goals[0].question]
    contenders = {goal.contender for goal in goals}
    own = [row for row in asked if row["contender"] in contenders]
    peers = [row for goal in goals for row in _rows_of_peer(goal, asked)]
    at = int(_parts(goals[0].contender)["at"])
    return _largest(own, at), _largest(peers, at)


def _rows_of_peer(goal: Goal, asked: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the row of Fast DDS at its largest number."""
    variant = _parts(goal.contender)["curve"].partition(", ")[2]
    is_own = goal.peer is None or FAST_DDS.name not in goal.peer
    suffix = f", {variant}" if variant else ""
    curve = FAST_DDS.name + suffix if is_own else _parts(goal.peer or "")["curve"]
    rows = [row for row in asked if row["curve"] == curve]
    return sorted(rows, key=lambda row: int(row["at"]))[-1:]


def _largest(rows: list[dict[str, Any]], at: int) -> str:
    """Return the largest median, with the number of its curve where that is another one."""
    if not rows:
        return ""
    row = max(rows, key=lambda row: float(row["median"]))
    measured_at = "" if int(row["at"]) == at else f" ({row['at']})"
    unit = "" if row["unit"] == "count" else f" {row['unit']}"
    return f"{number(row['median'])}{unit}{measured_at}"


def _goal_in_words(goal: Goal) -> str:
    if goal.kind == "better":
        return "< Fast DDS"
    if goal.peer is None:
        return f"≤ {goal.factor:g}"
    own, peer = _parts(goal.contender), _parts(goal.peer)
    variant = _PARTY.sub("", peer["curve"], count=1) or "with nothing beside"
    other = f"at {peer['at']}" if own["at"] != peer["at"] else variant
    return f"≤ {goal.factor:g} x {other}"


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
