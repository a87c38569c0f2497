# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Complete picture of a look: layout, current state, and SVG."""

from __future__ import annotations

from dataclasses import dataclass

from rmw_manycore_py.picture.drawing import draw
from rmw_manycore_py.picture.layout import Layout, lay_out
from rmw_manycore_py.picture.marks import Marks, marks_of
from rmw_manycore_py.platform.monitor.watch import Look


@dataclass(frozen=True)
class Chip:
    """Layout; valid until something joins or leaves."""

    title: str
    layout: Layout

    @classmethod
    def of(cls, look: Look) -> Chip:
        """Lay out the platform of a look."""
        graph = look.graph
        present = [cluster.id for cluster in look.loads.after.clusters]
        layout = lay_out(graph, present, look.dead, look.workers)
        return cls(f"platform {graph.platform}", layout)

    def fits(self, look: Look, earlier: Look) -> bool:
        """Return whether this layout, made for the earlier look, also fits the later one."""
        return (
            look.graph is earlier.graph
            and look.dead == earlier.dead
            and look.workers == earlier.workers
            and len(look.loads.after.clusters) == len(earlier.loads.after.clusters)
        )

    def marks(self, look: Look) -> Marks:
        """Return the current state of all elements."""
        return marks_of(look, self.layout)

    def svg(self, marks: Marks, *, standalone: bool = True) -> str:
        """Return the picture as SVG."""
        return draw(self.title, self.layout, marks, standalone=standalone)
