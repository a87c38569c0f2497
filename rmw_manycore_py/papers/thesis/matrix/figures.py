# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Figures 4.9 to 4.12 of the thesis: time over threads, on a logarithmic and on a linear axis."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from rmw_manycore_py.bench.box_plot import Boxes, draw_boxes
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.papers.thesis.matrix.cases import IO_DDR, LARGE, OFFLOAD, SMALL, Case

Draw = Callable[[Sequence[Result], Path], list[Path]]


def figures(cases: Sequence[Case], where: str) -> Draw:
    """Return the function that draws the figures of which there are results."""

    def draw(results: Sequence[Result], directory: Path) -> list[Path]:
        samples = {(r.question, r.contender): r.samples for r in results}
        written = []
        for name, (title, of_it) in _figures(cases).items():
            series: dict[str, dict[str, Sequence[float]]] = {}
            for case in of_it:
                found = samples.get((case.question, case.name))
                if found:
                    kind = "cached" if case.is_cached else "uncached"
                    label = f"{case.place}, {kind}"
                    series.setdefault(label, {})[str(case.threads)] = found
            if series:
                groups = [str(t) for t in sorted({case.threads for case in of_it})]
                boxes = Boxes(f"{title}, {where}", "threads", "ms", groups, series)
                written.append(directory / f"{name}.svg")
                draw_boxes(boxes, written[-1])
        return written

    return draw


def _figures(cases: Sequence[Case]) -> dict[str, tuple[str, list[Case]]]:
    """Return title and cases of each figure by file name."""
    in_place = [case for case in cases if case.place != OFFLOAD and case.n == cases[0].n]
    found = {
        "figure_4_9": ("Fig. 4.9: with cache", [c for c in in_place if c.is_cached]),
        "figure_4_10": ("Fig. 4.10: without cache", [c for c in in_place if not c.is_cached]),
    }
    for n in sorted({case.n for case in cases}):
        compared = [
            case
            for case in cases
            if case.n == n and (case.place == OFFLOAD or (case.place == IO_DDR and case.is_cached))
        ]
        number = {SMALL: "4_11", LARGE: "4_12"}.get(n, f"4_11_n_{n}")
        found[f"figure_{number}"] = (f"Off-loading, {n} x {n}", compared)
    return found
