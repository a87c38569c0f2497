# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fig. 12 of ROS-lite2: lines of code over the number of nodes, with real mapfiles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py.create.report import count_lines, delta_loc, estimated_loc
from rmw_manycore_py.mapfile import check
from rmw_manycore_py.picture.plotting import load_figure

FILE = "figure_12.svg"
MAX_NODES = 50
# Of an average ROS 2 node, as estimated in the paper.
PARAMETERS = TOPICS = 15
PAPERS_REDUCTION = 0.86
LINE = f"by hand: N (10 + N_p + 6 N_t), N_p = N_t = {TOPICS}"


@dataclass(frozen=True)
class Dot:
    """A mapfile in the figure: its nodes, its lines, and the lines its nodes take by hand."""

    name: str
    nodes: int
    written_lines: int
    delta_loc: int

    @property
    def reduction(self) -> float:
        """Fraction of lines saved compared with writing by hand, 0 to 1."""
        return 1 - self.written_lines / self.delta_loc if self.delta_loc else 0.0


def dot_of(mapfile: Path) -> Dot:
    """Return the dot of a mapfile; raise ManycoreError if it is invalid."""
    placement = check(mapfile)
    return Dot(
        mapfile.stem if mapfile.suffix == ".yaml" else mapfile.name,
        len(placement.nodes),
        count_lines(mapfile.read_text(encoding="utf-8")),
        delta_loc(placement.nodes),
    )


def by_hand() -> Sequence[int]:
    """Return the paper's estimate: lines for 0 to 50 average nodes."""
    return [estimated_loc(nodes, PARAMETERS, TOPICS) for nodes in range(MAX_NODES + 1)]


def draw(dots: Sequence[Dot], path: Path) -> None:
    """Draw the estimate and the dots."""
    figure = load_figure()(figsize=(8, 5), layout="constrained")
    panel = figure.subplots()
    panel.plot(by_hand(), label=LINE, color="tab:gray")
    for dot in dots:
        (mark,) = panel.plot(dot.nodes, dot.delta_loc, "o", label=f"{dot.name}: by hand")
        panel.plot(
            dot.nodes,
            dot.written_lines,
            "x",
            color=mark.get_color(),
            label=f"{dot.name}: its mapfile, {dot.reduction:.0%} less",
        )
    panel.set(xlabel="nodes", ylabel="lines", xlim=0, ylim=0)
    panel.legend(fontsize="small")
    figure.savefig(path)
