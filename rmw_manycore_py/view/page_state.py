# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""State of one open page, and pending updates."""

from __future__ import annotations

import time
from typing import Any

from rmw_manycore_py.picture.arcs import Arc
from rmw_manycore_py.picture.chip import Chip
from rmw_manycore_py.picture.marks import Marks, changed
from rmw_manycore_py.platform.monitor.watch import Look
from rmw_manycore_py.view.details import node_details, topic_details
from rmw_manycore_py.view.viewer import Viewer

Row = dict[str, Any]


class PageState:
    """Converts looks to messages for one page; a slow page gets fewer, but complete ones."""

    def __init__(self, viewer: Viewer) -> None:
        self._viewer = viewer
        self._chip: Chip | None = None
        self._marks: Marks = {}
        self._happened = 0
        self._has_charts = False
        self._selected: tuple[str, str] | None = None  # kind and name
        self._has_selected = False

    def select(self, message: Any) -> None:
        """Set the selection: {"select": {"node": NAME}}, or "topic", or null."""
        chosen = message.get("select") if isinstance(message, dict) else None
        self._selected, self._has_selected = None, False
        if isinstance(chosen, dict):
            for kind in ("node", "topic"):
                if isinstance(chosen.get(kind), str):
                    self._selected = (kind, chosen[kind])

    def news(self) -> Row:
        """Return the changes since the last call."""
        viewer = self._viewer
        self._happened, happened = viewer.happened_since(self._happened)
        news: Row = {
            "now": time.time(),
            "state": viewer.state,
            "there": viewer.is_there,
            "happened": happened,
        }
        if viewer.chip is not None and viewer.look is not None:
            self._add_picture(news, viewer.chip)
            self._add_charts(news)
            news["trace"] = _trace_row(viewer.look)
            if self._selected is not None:
                news["details"] = self._details(viewer.look, *self._selected)
        return news

    def _add_picture(self, news: Row, chip: Chip) -> None:
        marks = self._viewer.marks
        if chip is not self._chip:
            news["svg"] = chip.svg(marks, standalone=False)
            arcs = chip.layout.arcs
            news["arcs"] = {arc.id: _arc_row(arc) for arc in arcs}
            news["nodes"] = [node.name for node in chip.layout.nodes]
            news["topics"] = list(self._viewer.look.graph.topics) if self._viewer.look else []
            news["rates"] = {arc.id: marks.get(arc.id, {}).get("rate", 0) for arc in arcs}
            self._chip = chip
        else:
            news["marks"] = changed(self._marks, marks)
        self._marks = marks

    def _add_charts(self, news: Row) -> None:
        if self._viewer.is_there or not self._has_charts:
            news["charts"] = self._viewer.history.whole(1 if self._has_charts else None)
            news["charts"]["all"] = not self._has_charts
            self._has_charts = True

    def _details(self, look: Look, kind: str, name: str) -> Row:
        history = self._viewer.history
        newest = 1 if self._has_selected else None
        if kind == "node":
            found, series = node_details(look, name), history.of_node(name, newest)
        else:
            found, series = topic_details(look, name), history.of_topic(name, newest)
        series["all"] = not self._has_selected
        self._has_selected = True
        return {"kind": kind, "name": name, "found": found, "charts": series}


def _arc_row(arc: Arc) -> Row:
    lines = [[round(value, 1) for point in line for value in point] for line in arc.lines]
    return {"lines": lines, "topics": arc.wire.nodes_of}


def _trace_row(look: Look) -> Row | None:
    if look.trace is None:
        return None
    return {
        "on": look.trace.started_ns != 0,
        "events": look.trace.pending,
        "lost": look.trace.lost,
    }
