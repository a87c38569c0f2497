# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Box plots: quartiles, whiskers to 1.5 times their distance, and samples beyond."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rmw_manycore_py.picture.plotting import load_figure

_COLOURS = ("tab:blue", "tab:orange", "tab:green", "tab:red", "tab:purple", "tab:brown")
_WIDTH = 0.8
SCALES = ("log", "linear")


@dataclass(frozen=True)
class Boxes:
    """A figure: for each group on the axis a box for each series, from samples.

    A series lacks the groups that were not measured.
    """

    title: str
    axis: str
    unit: str
    groups: Sequence[str]
    series: Mapping[str, Mapping[str, Sequence[float]]]


def draw_boxes(boxes: Boxes, path: Path) -> None:
    """Draw the figure twice side by side, on a logarithmic and on a linear axis."""
    figure = load_figure()(figsize=(13, 4.5), layout="constrained")
    figure.suptitle(boxes.title)
    for panel, scale in zip(figure.subplots(1, 2), SCALES, strict=True):
        _draw(panel, boxes)
        panel.set_yscale(scale)
        panel.set(xlabel=boxes.axis, ylabel=boxes.unit, title=f"{scale} axis")
    figure.savefig(path)


def _draw(panel: Any, boxes: Boxes) -> None:
    width = _WIDTH / max(len(boxes.series), 1)
    handles = []
    for number, (name, samples) in enumerate(boxes.series.items()):
        present = [group for group in boxes.groups if group in samples]
        shift = (number + 0.5) * width - _WIDTH / 2
        drawn = panel.boxplot(
            [samples[group] for group in present],
            positions=[boxes.groups.index(group) + shift for group in present],
            widths=0.9 * width,
            patch_artist=True,
            manage_ticks=False,
            flierprops={"markersize": 2},
            medianprops={"color": "black"},
        )
        for box in drawn["boxes"]:
            box.set_facecolor(_COLOURS[number % len(_COLOURS)])
        handles.append((drawn["boxes"][0], name))
    panel.set_xticks(range(len(boxes.groups)), boxes.groups)
    panel.legend(*zip(*handles, strict=True), fontsize="small")
