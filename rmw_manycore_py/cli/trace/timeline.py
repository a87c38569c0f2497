# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Timeline of the threads that a message passes through."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from rmw_manycore_py.cli.common.output_file import writing
from rmw_manycore_py.picture.plotting import load_figure
from rmw_manycore_py.trace.chains import Passage
from rmw_manycore_py.trace.events import Process, Trace
from rmw_manycore_py.trace.flows import flows_of
from rmw_manycore_py.trace.names import core_name, place_order, process_name
from rmw_manycore_py.trace.slices import Slices, category_of, name_of, slices_of

_COLORS = {
    "wait": "#e8e8e8",
    "callback": "#9ecae1",
    "take": "#3182bd",
    "publish": "#31a354",
    "serialize": "#a1d99b",
    "receive": "#fd8d3c",
    "bridge": "#756bb1",
    "ndt": "#e7969c",
}
_HEIGHTS = {"serialize": 0.3, "take": 0.5, "publish": 0.5, "wait": 0.3}
_MARGIN = 0.08  # fraction of the drawn time, before and after
_MIN_NAMED = 0.15  # fraction of the drawn time from which a slice is labelled


def draw(trace: Trace, passage: Passage, path: Path) -> None:
    """Draw what all participating threads did, from the first publish to the last callback."""
    margin_ns = int(_MARGIN * (passage.callback_ns[-1] - passage.published_ns[0]))
    window_ns = (passage.published_ns[0] - margin_ns, passage.callback_ns[-1] + margin_ns)
    rows = _rows(trace, window_ns)
    figure = load_figure()(figsize=(11, 1.2 + 0.55 * len(rows)), layout="constrained")
    axes = figure.subplots()
    for y, (_, slices) in enumerate(rows.values()):
        _draw_thread(axes, trace, slices, y, window_ns)
    _draw_flows(axes, trace, list(rows), window_ns)
    axes.set_yticks(range(len(rows)), [_label(trace, process) for process, _ in rows.values()])
    axes.set_xlim(0, (window_ns[1] - window_ns[0]) / 1000)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_xlabel("us")
    shown = {category_of(what) for _, slices in rows.values() for what in np.unique(slices["what"])}
    handles = [
        axes.barh(0, 0, color=color, label=name) for name, color in _COLORS.items() if name in shown
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles), fontsize="small")
    with writing(path):
        figure.savefig(path)


def _rows(trace: Trace, window_ns: tuple[int, int]) -> dict[int, tuple[Process, Slices]]:
    """Return the threads that are active in that time, by index, grouped by cluster."""
    found = {}
    for index, (process, thread) in enumerate(trace.threads()):
        slices = slices_of(thread)
        slices = slices[(slices["end_ns"] >= window_ns[0]) & (slices["begin_ns"] <= window_ns[1])]
        if {category_of(what) for what in np.unique(slices["what"])} - {"wait", "event"}:
            found[index] = (process, slices)
    order = sorted(found, key=lambda index: place_order(found[index][0]))
    return {index: found[index] for index in order}


def _label(trace: Trace, process: Process) -> str:
    place = f"cluster {process.cluster}\n{core_name(process)}"
    return place if process.is_receive_thread else f"{place} > {process_name(trace, process)}"


def _draw_thread(
    axes: Any, trace: Trace, slices: Slices, y: int, window_ns: tuple[int, int]
) -> None:
    begin_ns, end_ns = window_ns
    for one in slices[~slices["is_instant"]]:
        category = category_of(one["what"])
        left_us = (max(one["begin_ns"], begin_ns) - begin_ns) / 1000
        width_us = (min(one["end_ns"], end_ns) - begin_ns) / 1000 - left_us
        height = _HEIGHTS.get(category, 0.7)
        axes.barh(y, width_us, left=left_us, height=height, color=_COLORS[category], zorder=2)
        if width_us > _MIN_NAMED * (end_ns - begin_ns) / 1000:
            name = name_of(trace, one["what"], int(one["endpoint"]))
            axes.text(left_us + width_us / 2, y, name, ha="center", va="center", fontsize=7)


def _draw_flows(axes: Any, trace: Trace, rows: list[int], window_ns: tuple[int, int]) -> None:
    begin_ns, end_ns = window_ns
    flows = flows_of(trace).flows
    arrow = {"arrowstyle": "->", "color": "black", "lw": 0.8, "shrinkA": 0, "shrinkB": 0}
    for flow in flows[(flows["write_ns"] >= begin_ns) & (flows["claim_ns"] <= end_ns)]:
        places = [
            ((flow[f"{step}_ns"] - begin_ns) / 1000, rows.index(flow[f"{step}_thread"]))
            for step in ("write", "receive", "claim")
            if flow[f"{step}_thread"] in rows
        ]
        for start, end in pairwise(places):
            axes.annotate("", xy=end, xytext=start, arrowprops=arrow, zorder=3)
