# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parallel tracks within a channel: what overlaps runs side by side."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

LINE_SIZE = 7.0
LABEL_SIZE = 30.0
MARGIN = 7.0  # to both sides of a channel
MAX_LINES = 14  # further lines share tracks
_APART = 10.0  # between neighbours in a track


class Label(NamedTuple):
    """Place of a label along a channel."""

    middle: float
    width: float


class Extent(NamedTuple):
    """Part of a channel that a wire takes, along it; its label included."""

    low: float
    high: float
    label: Label | None = None

    @property
    def middle(self) -> float:
        """Half way."""
        return (self.low + self.high) / 2


@dataclass(frozen=True)
class Tracks:
    """Size of a channel, and the distance of each wire's track from its edge."""

    size: float
    places: Mapping[int, float]


def tracks_for(extents: Mapping[int, Extent]) -> Tracks:
    """Return tracks for wires, so that none overlaps a label."""
    ends: list[float] = []  # of each track, how far it is taken
    sizes: list[float] = []
    chosen: dict[int, int] = {}
    wires = sorted(extents, key=lambda one: (extents[one].label is None, extents[one].low))
    labelled = 0
    for wire in wires:
        extent = extents[wire]
        free = (n for n, end in enumerate(ends) if end + _APART <= extent.low)
        track = next(free, None)
        if track is None and extent.label is None and len(ends) - labelled >= MAX_LINES:
            track = labelled + wire % MAX_LINES
        if track is None:
            track = len(ends)
            ends.append(extent.low)
            sizes.append(LINE_SIZE if extent.label is None else LABEL_SIZE)
            labelled += extent.label is not None
        ends[track] = max(ends[track], extent.high)
        chosen[wire] = track
    starts = [MARGIN + sum(sizes[:n]) for n in range(len(sizes))]
    places = {wire: starts[track] + sizes[track] / 2 for wire, track in chosen.items()}
    return Tracks(sum(sizes) + 2 * MARGIN, places)
