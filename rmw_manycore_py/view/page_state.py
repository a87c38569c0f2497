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
from rmw_manycore_py.view.history import totals_of
from rmw_manycore_py.view.shown import Shown

Row = dict[str, Any]


class PageState:
    """Converts looks to messages for one page; a slow page gets fewer, but complete ones."""

    def __init__(self, shown: Shown) -> None:
        self._shown = shown
        self._chip: Chip | None = None
        self._marks: Marks = {}
        self._happened = 0
        self._has_charts = False
        self._selected: tuple[str, str] | None = None  # kind and name
        self._has_selected = False

    def receive(self, message: Any) -> None:
        """Follow the page: {"select": {"node": NAME}}, or "topic", or null; {"seek": STEP}."""
        if not isinstance(message, dict):
            return
        if "select" in message:
            self._select(message["select"])
        if "seek" in message:
            step = message["seek"]
            self._shown.seek(step if isinstance(step, int) else None)

    def _select(self, chosen: Any) -> None:
        self._selected, self._has_selected = None, False
        if isinstance(chosen, dict):
            for kind in ("node", "topic"):
                if isinstance(chosen.get(kind), str):
                    self._selected = (kind, chosen[kind])

    def news(self) -> Row:
        """Return the changes since the last call."""
        shown = self._shown
        self._happened, happened = shown.happened_since(self._happened)
        news: Row = {
            "now": time.time(),
            "state": shown.state,
            "there": shown.is_there,
            "position": shown.position,
            "happened": happened,
        }
        if shown.chip is not None and shown.look is not None:
            self._add_picture(news, shown.chip)
            self._add_charts(news)
            news["totals"] = totals_of(shown.look)
            news["trace"] = _trace_row(shown.look)
            if self._selected is not None:
                news["details"] = self._details(shown.look, *self._selected)
        return news

    def _add_picture(self, news: Row, chip: Chip) -> None:
        marks = self._shown.marks
        if chip is not self._chip:
            news["svg"] = chip.svg(marks, standalone=False)
            arcs = chip.layout.arcs
            news["arcs"] = {arc.id: _arc_row(arc) for arc in arcs}
            news["nodes"] = [node.name for node in chip.layout.nodes]
            news["topics"] = list(self._shown.look.graph.topics) if self._shown.look else []
            news["rates"] = {arc.id: marks.get(arc.id, {}).get("rate", 0) for arc in arcs}
            self._chip = chip
        else:
            news["marks"] = changed(self._marks, marks)
        self._marks = marks

    def _add_charts(self, news: Row) -> None:
        if not self._has_charts or (self._shown.is_live and self._shown.is_there):
            news["charts"] = self._shown.history.whole(self._newest(self._has_charts))
            news["charts"]["all"] = not self._has_charts
            self._has_charts = True

    def _newest(self, has_earlier: bool) -> int | None:
        """Return how many looks a chart lacks; None: all."""
        return int(self._shown.is_live) if has_earlier else None

    def _details(self, look: Look, kind: str, name: str) -> Row:
        history = self._shown.history
        newest = self._newest(self._has_selected)
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
