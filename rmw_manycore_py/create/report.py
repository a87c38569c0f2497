# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Lines saved by a mapfile: lines written against lines generated."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py.mapfile.placing.parameters import read_all
from rmw_manycore_py.mapfile.placing.placement import PlacedNode, Placement
from rmw_manycore_py.ros.parameter_files import values_for

# Terms of ROS-lite2, section V-A: lines per node, and per topic of a node.
_LINES_PER_NODE = 10
_LINES_PER_TOPIC = 6


@dataclass(frozen=True)
class CreateReport:
    """Result of `create`; line counts exclude blank lines and comments."""

    directory: Path
    files: tuple[Path, ...]
    placement: Placement
    written_lines: int
    generated_lines: int
    delta_loc: int

    @property
    def summary(self) -> str:
        """One line: lines written, generated, and the paper's estimate."""
        return (
            f"{self.written_lines} lines written, {self.generated_lines} lines generated "
            f"(dLoC = {self.delta_loc} for {len(self.placement.nodes)} nodes)"
        )


def estimated_loc(nodes: int, parameters: int, topics: int) -> int:
    """Return N (10 + N_p + 6 N_t), the estimated lines of N nodes (ROS-lite2, section V-A)."""
    return nodes * (_LINES_PER_NODE + parameters + _LINES_PER_TOPIC * topics)


def delta_loc(nodes: Iterable[PlacedNode]) -> int:
    """Return the sum over the nodes of 10 + N_p + 6 N_t (ROS-lite2, section V-A)."""
    return sum(estimated_loc(1, _parameters(node), _topics(node)) for node in nodes)


def _parameters(node: PlacedNode) -> int:
    return len(values_for(read_all(node.parameter_sources), node.full_name))


def _topics(node: PlacedNode) -> int:
    return len({*node.publish, *node.subscribe})


def count_lines(text: str) -> int:
    """Return the lines that are neither blank nor comments."""
    lines = (line.strip() for line in text.splitlines())
    return sum(bool(line) and not line.startswith("#") for line in lines)
