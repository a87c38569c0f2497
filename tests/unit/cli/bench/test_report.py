# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reports: table, CSV and JSON agree."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from rmw_manycore_py.bench.summary import Goal, Result, Verdict, judge
from rmw_manycore_py.cli.bench.report import Report, in_words, number

pytestmark = pytest.mark.unit

RESULTS = [
    Result("round trip, 64 B", 'the "own" one', "us", (1.0, 2.0, 4.5)),
    Result("throughput", "peer", "1/s", (1000.0,), higher_is_better=True),
    Result("round trip, 64 B", "peer", "us", (8.0,)),
]
GOAL = Goal("round trip, 64 B", 'the "own" one', "better", 3, "peer")
REPORT = Report({"kernel": "6.1"}, {"CPUs": "0, 1"}, RESULTS, judge(RESULTS, [GOAL]), [])


def read_csv(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_csv_holds_every_sample_and_a_row_per_result(tmp_path: Path) -> None:
    _, results_path, samples_path = REPORT.write(tmp_path / "new" / "directory")
    samples = read_csv(samples_path)
    assert [float(row["sample"]) for row in samples] == [1.0, 2.0, 4.5, 1000.0, 8.0]
    rows = read_csv(results_path)
    assert [row["contender"] for row in rows] == ['the "own" one', "peer", "peer"]
    assert float(rows[0]["median"]) == 2.0
    assert rows[0]["samples"] == "3"


def test_json_has_the_verdicts_beside_the_goals() -> None:
    data = json.loads(REPORT.as_json())
    assert data["machine"] == {"kernel": "6.1"}
    assert data["results"][1]["unit"] == "1/s"
    (goal,) = data["goals"]
    assert (goal["found"], goal["reached"]) == (4.0, True)


def test_tables_keep_the_contenders_of_a_question_together(
    capsys: pytest.CaptureFixture[str],
) -> None:
    REPORT.print()
    lines = capsys.readouterr().out.splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("question"))
    assert lines[start + 1].startswith("round trip, 64 B")
    assert "8.00" in lines[start + 2]
    assert lines[start + 3].strip() == ""
    assert lines[start + 4].startswith("throughput")
    assert any("reached" in line for line in lines)


@pytest.mark.parametrize(
    ("value", "text"),
    [(0, "0"), (0.934, "0.93"), (41.26, "41.3"), (733.2, "733"), (21000.4, "21,000")],
)
def test_numbers_have_about_three_digits(value: float, text: str) -> None:
    assert number(value) == text


@pytest.mark.parametrize(
    ("goal", "words"),
    [
        (Goal("q", "own", "within", 1.2, "peer"), "<= 1.2 x peer"),
        (Goal("q", "own", "within", 5), "<= 5"),
        (Goal("q", "own", "better", 10, "peer", "mean"), ">= 10 x better than peer (mean)"),
    ],
)
def test_goals_in_words(goal: Goal, words: str) -> None:
    assert in_words(Verdict(goal, 1.0)) == words
