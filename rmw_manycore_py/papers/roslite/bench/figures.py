# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fig. 13 to 16 as box plots, each on a logarithmic and on a linear axis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from rmw_manycore_py.bench.box_plot import Boxes, draw_boxes
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.papers.roslite.bench import end_to_end, sending, split

Samples = Mapping[tuple[str, str], Sequence[float]]


def draw(results: Sequence[Result], directory: Path) -> list[Path]:
    """Draw the figures of which there are results."""
    samples = {(result.question, result.contender): result.samples for result in results}
    written = []
    for name, boxes in _figures(samples).items():
        if boxes.series:
            written.append(directory / f"{name}.svg")
            draw_boxes(boxes, written[-1])
    return written


def _figures(samples: Samples) -> dict[str, Boxes]:
    found = {
        f"figure_13_{waypoints}": Boxes(
            f"Fig. 13: what each node sends, lanes of {waypoints} waypoints",
            *("sending node", "us"),
            list(sending.SENT),
            _series(
                samples,
                sending.TRANSFERS,
                {
                    node: {(sending.question_of(node, waypoints), t): t for t in sending.TRANSFERS}
                    for node in sending.SENT
                },
            ),
        )
        for waypoints in sending.LANES
    }
    sides = (end_to_end.BEFORE, end_to_end.AFTER)
    for number, question in (("14", end_to_end.ALIGNMENT), ("16", end_to_end.COMMAND)):
        groups = {question: {(question, name): name for name in sides}}
        title = f"Fig. {number}: {question}"
        series = _series(samples, sides, groups)
        found[f"figure_{number}"] = Boxes(title, "", "ms", [question], series)
    labels = {searches: f"{searches} clusters of radius_search" for searches in split.SEARCHES}
    groups = {
        str(count): {
            (split.QUESTION, split.contender(count, searches)): label
            for searches, label in labels.items()
        }
        for count in split.DERIVATIVES
    }
    series = _series(samples, tuple(labels.values()), groups)
    title = "Fig. 15: one pass of lidar_localizer"
    found["figure_15"] = Boxes(title, "clusters of derivatives", "ms", list(groups), series)
    return found


def _series(
    samples: Samples, names: Sequence[str], groups: Mapping[str, Mapping[tuple[str, str], str]]
) -> dict[str, dict[str, Sequence[float]]]:
    """Return the samples by series and group; `groups` has the series of each result."""
    found: dict[str, dict[str, Sequence[float]]] = {name: {} for name in names}
    for group, keys in groups.items():
        for key, name in keys.items():
            if key in samples:
                found[name][group] = samples[key]
    return {name: of_groups for name, of_groups in found.items() if of_groups}
