# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A picture of the results, where matplotlib is installed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.errors import ManycoreError

COLUMNS = 2
# Beyond this ratio of the longest line to the shortest bar the bar could not be seen.
LINEAR_UP_TO = 20


def plot(results: Sequence[Result], path: Path) -> None:
    """Draw a panel per question: a bar to the median, a line to the 99th percentile."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise ManycoreError(
            "the plot needs matplotlib: pip install 'rmw-manycore[bench]'"
        ) from None
    questions = list(dict.fromkeys(r.question for r in results if r.summary.largest > 0))
    rows = math.ceil(len(questions) / COLUMNS)
    figure = Figure(figsize=(7 * COLUMNS, 2.4 * rows), layout="constrained")
    panels = figure.subplots(rows, COLUMNS, squeeze=False).flatten()
    for panel, question in zip(panels, questions, strict=False):
        _draw(panel, question, [r for r in results if r.question == question])
    for panel in panels[len(questions) :]:
        panel.remove()
    figure.savefig(path)


def _draw(panel: Any, question: str, results: Sequence[Result]) -> None:
    names = [result.contender for result in results]
    medians = [result.summary.median for result in results]
    tails = [result.summary.p99 - result.summary.median for result in results]
    colours = ["tab:blue" if "manycore" in name else "tab:gray" for name in names]
    panel.barh(names, medians, xerr=[[0.0] * len(tails), tails], color=colours, ecolor="0.3")
    panel.invert_yaxis()
    panel.set_title(question)
    panel.set_xlabel(results[0].unit)
    if 0 < LINEAR_UP_TO * min(medians) < max(r.summary.p99 for r in results):
        panel.set_xscale("log")
        panel.set_xlim(left=10 ** math.floor(math.log10(min(medians))))
