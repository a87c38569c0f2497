# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A plot has a panel per question; if it cannot be drawn, the bench fails before the run."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from rmw_manycore_py.bench.plot import plot
from rmw_manycore_py.bench.summary import Curve, Result
from rmw_manycore_py.cli.bench.report import Report
from rmw_manycore_py.picture.plotting import load_figure

pytestmark = pytest.mark.unit

RESULTS = [
    *(
        Result("time", f"{n} workers", "ms", (6 / n, 6.5 / n, 7 / n), curve=Curve("workers", n))
        for n in (1, 2, 4)
    ),
    Result("time", "PCL", "ms", (200.0, 210.0, 250.0)),
    Result("share", "search", "%", (10.0, 11.0)),
]


@pytest.mark.needs("matplotlib")
def test_curves_and_bars_are_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = []
    figure = load_figure()
    monkeypatch.setattr(figure, "savefig", lambda self, path: drawn.append(self))
    plot(RESULTS, tmp_path / "plot.svg")
    over_cores, bars = drawn[0].axes
    assert {line.get_label(): list(line.get_xdata()) for line in over_cores.lines} == {
        "workers": [1, 2, 4],
        "PCL": [1],
    }
    assert [line.get_ydata()[0] for line in over_cores.lines] == [6.5, 210.0]
    assert over_cores.get_yscale() == "log"
    assert over_cores.get_xscale() == "linear"
    assert bars.get_title() == "share"
    assert len(bars.patches) == 1


@pytest.mark.needs("matplotlib")
def test_a_curve_over_orders_of_magnitude_has_a_logarithmic_axis(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn = []
    figure = load_figure()
    monkeypatch.setattr(figure, "savefig", lambda self, path: drawn.append(self))
    depths = (1, 100, 10_000)
    curve = [
        Result("publish", f"{n} kept", "us", (0.2,), curve=Curve("own", n, "messages kept"))
        for n in depths
    ]
    plot(curve, tmp_path / "plot.svg")
    (panel,) = drawn[0].axes
    assert panel.get_xscale() == "log"
    assert [label.get_text() for label in panel.get_xticklabels()] == ["1", "100", "10,000"]


@pytest.mark.needs("matplotlib")
def test_a_picture_is_a_file(tmp_path: Path) -> None:
    plot(RESULTS, tmp_path / "plot.svg")
    assert "<svg" in (tmp_path / "plot.svg").read_text()


def test_the_table_has_curve_and_spread(tmp_path: Path) -> None:
    Report({}, {}, RESULTS, [], []).write(tmp_path)
    with (tmp_path / "results.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [(row["curve"], row["at"]) for row in rows[2:4]] == [("workers", "4"), ("", "")]
    assert (float(rows[3]["p5"]), float(rows[3]["p95"])) == (200.0, 250.0)
