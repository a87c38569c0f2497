# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Figures 4.2 to 4.7 of the thesis: box plots, each on a logarithmic and on a linear axis."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from rmw_manycore_py.bench.box_plot import Boxes, draw_boxes
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.papers.thesis.noc.cases import Case, Setting, question_of, size_name
from rmw_manycore_py.prediction.bostan.dma import Method
from rmw_manycore_py.prediction.bostan.memory import MemoryKind

# The caption of Fig. 4.4 repeats that of 4.5; the text says Tx.
_PANELS: dict[str, tuple[Method, MemoryKind]] = {
    "4.2": ("Tx", "IO DDR"),
    "4.3": ("UC", "IO DDR"),
    "4.4": ("Tx", "IO SMEM"),
    "4.5": ("UC", "IO SMEM"),
}

Draw = Callable[[Sequence[Result], Path], list[Path]]


def figures(setting: Setting, sizes: Sequence[int], where: str) -> Draw:
    """Return the function that draws the figures of which there are results."""

    def draw(results: Sequence[Result], directory: Path) -> list[Path]:
        samples = {(r.question, r.contender): r.samples for r in results}
        written = []
        for name, title, cases in _figures(setting):
            series = {label: _of(samples, case, sizes) for label, case in cases.items()}
            series = {label: found for label, found in series.items() if found}
            if series:
                groups = [size_name(size) for size in sizes]
                boxes = Boxes(f"{title}, {where}", "data size", "us", groups, series)
                written.append(directory / f"{name}.svg")
                draw_boxes(boxes, written[-1])
        return written

    return draw


def _figures(setting: Setting) -> list[tuple[str, str, dict[str, Case]]]:
    """Return file name, title and series of each figure."""
    found = []
    for number, (method, source) in _PANELS.items():
        cases = {route: Case(method, source, route) for route in setting.routes}
        title = f"Fig. {number}: {method} from {source} to CC"
        found.append((f"figure_{number.replace('.', '_')}", title, cases))
    compared = {
        f"{case.method} from {case.source}": case
        for case in setting.cases
        if case.route in (setting.main, setting.between)
    }
    found.append(("figure_4_6_and_4_7", "Fig. 4.6 and 4.7: Tx and UC", compared))
    return found


def _of(
    samples: Mapping[tuple[str, str], Sequence[float]], case: Case, sizes: Sequence[int]
) -> dict[str, Sequence[float]]:
    return {
        size_name(size): samples[question_of(size), case.name]
        for size in sizes
        if (question_of(size), case.name) in samples
    }
