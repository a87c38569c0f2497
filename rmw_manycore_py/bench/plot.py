# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Plot of the results."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rmw_manycore_py.bench.summary import SPREAD, Result, nearest_rank
from rmw_manycore_py.picture.plotting import load_figure

COLUMNS = 2
# Maximum ratio of the largest to the smallest value on a linear scale.
LINEAR_UP_TO = 20


def plot(results: Sequence[Result], path: Path) -> None:
    """Draw a panel per question: curves or bars."""
    questions = list(dict.fromkeys(r.question for r in results if r.summary.largest > 0))
    rows = math.ceil(len(questions) / COLUMNS)
    figure = load_figure()(figsize=(7 * COLUMNS, 2.8 * rows), layout="constrained")
    panels = figure.subplots(rows, COLUMNS, squeeze=False).flatten()
    for panel, question in zip(panels, questions, strict=False):
        asked = [r for r in results if r.question == question]
        panel.set_title(question)
        draw = _draw_curves if any(r.curve for r in asked) else _draw_bars
        draw(panel, asked)
    for panel in panels[len(questions) :]:
        panel.remove()
    figure.savefig(path)


def _draw_bars(panel: Any, results: Sequence[Result]) -> None:
    """Draw a bar to the median and a line to the 99th percentile."""
    names = [result.contender for result in results]
    medians = [result.summary.median for result in results]
    tails = [result.summary.p99 - result.summary.median for result in results]
    colours = ["tab:blue" if "manycore" in name else "tab:gray" for name in names]
    panel.barh(names, medians, xerr=[[0.0] * len(tails), tails], color=colours, ecolor="0.3")
    panel.invert_yaxis()
    panel.set_xlabel(results[0].unit)
    if 0 < LINEAR_UP_TO * min(medians) < max(r.summary.p99 for r in results):
        panel.set_xscale("log")
        panel.set_xlim(left=10 ** math.floor(math.log10(min(medians))))


def _draw_curves(panel: Any, results: Sequence[Result]) -> None:
    """Draw medians over the curve's axis with a band from the 5th to the 95th percentile.

    A result on no curve is drawn as a single mark with its spread.
    """
    axis = next(r.curve.axis for r in results if r.curve)
    names = list(dict.fromkeys(r.curve.name if r.curve else r.contender for r in results))
    for name in names:
        found = [r for r in results if name == (r.curve.name if r.curve else r.contender)]
        found.sort(key=_place)
        places = [_place(result) for result in found]
        low, high = ([_rank(r, share) for r in found] for share in SPREAD)
        medians = [result.summary.median for result in found]
        (line,) = panel.plot(places, medians, marker="o", markersize=4, label=name)
        panel.fill_between(places, low, high, alpha=0.2, color=line.get_color())
        panel.vlines(places, low, high, alpha=0.5, color=line.get_color())
    panel.set(xlabel=axis, ylabel=results[0].unit)
    _mark_places(panel, sorted({_place(r) for r in results}))
    if max(r.summary.median for r in results) > LINEAR_UP_TO * min(
        r.summary.median for r in results
    ):
        panel.set_yscale("log")
    else:
        panel.set_ylim(bottom=0)
    panel.legend(fontsize="small")


def _mark_places(panel: Any, places: Sequence[int]) -> None:
    """Label the measured places; over several orders of magnitude on a logarithmic axis."""
    if places[-1] > LINEAR_UP_TO * places[0]:
        panel.set_xscale("log")
    panel.set_xticks(places, [f"{place:,}" for place in places])
    panel.tick_params(axis="x", which="minor", bottom=False, labelbottom=False)


def _place(result: Result) -> int:
    return result.curve.at if result.curve else 1


def _rank(result: Result, share: float) -> float:
    return nearest_rank(sorted(result.samples), share)
