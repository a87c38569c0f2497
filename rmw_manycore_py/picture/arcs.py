# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Topics as lines from publishing to subscribing cells, around all others."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from rmw_manycore_py.picture.frame import PAD, Bands, Channel, Frame, Kind
from rmw_manycore_py.picture.geometry import Line, Rect, without_repetition
from rmw_manycore_py.picture.plan import ClusterPlan
from rmw_manycore_py.picture.routing import Route, Router
from rmw_manycore_py.picture.texts import BOLD, SMALL, width_of
from rmw_manycore_py.picture.tracks import LABEL_SIZE, Extent, Label, Tracks, tracks_for
from rmw_manycore_py.picture.wires import Wire

# The page lists all topics; the details of a line name those folded into it.
MAX_LABELS = 40
LOAD_LENGTH = 30  # characters of a label's second line
_USUAL = 40.0  # size of channels, until it is known
_ASIDE = 3.0  # of the ports of lower and upper sides, which face each other


_Port = tuple[str, Channel, int, bool]  # cell, channel at its side, wire, whether it publishes
_Extents = dict[Channel, dict[int, Extent]]  # by wire


@dataclass(frozen=True)
class Arc:
    """A wire as drawn."""

    wire: Wire
    lines: tuple[Line, ...]
    label: Rect | None

    @property
    def id(self) -> str:
        """Element id."""
        return self.wire.id

    @cached_property
    def label_id(self) -> str:
        """Element id of the second line of its label."""
        return f"{self.id}-label"

    @cached_property
    def name(self) -> str:
        """First line of its label."""
        return self.wire.name


class Wiring:
    """Gives wires their tracks: first those in gutters, then those between the gutters.

    The gutters decide how far apart cells lie across, what lies between them how far down.
    """

    def __init__(
        self, clusters: Sequence[ClusterPlan], bands: Bands, wires: Sequence[Wire]
    ) -> None:
        self._wires = wires
        nominal = Frame(clusters, bands, {}, _USUAL)
        router = Router(clusters, nominal)
        self._routes = [[router.route(pair) for pair in wire.pairs] for wire in wires]
        self._tracks: dict[Channel, Tracks] = {}
        self._frame = nominal
        self._fit(self._of_gutters())
        self._frame = Frame(clusters, bands, self._sizes(), _USUAL)
        self._ports = self._place_ports()
        self._extents = self._of_rows()
        self._labels = self._choose_labels()
        self._fit(self._extents)
        self.frame = self._frame = Frame(clusters, bands, self._sizes())

    def arcs(self) -> tuple[Arc, ...]:
        """Return the wires as drawn."""
        return tuple(
            Arc(
                wire,
                tuple(self._line(number, route) for route in self._routes[number]),
                self._label(number),
            )
            for number, wire in enumerate(self._wires)
        )

    def _sizes(self) -> Mapping[Channel, float]:
        return {channel: tracks.size for channel, tracks in self._tracks.items()}

    def _fit(self, extents: _Extents) -> None:
        self._tracks.update({channel: tracks_for(own) for channel, own in extents.items()})

    def _at(self, channel: Channel, wire: int) -> float:
        """Return where a wire runs in a channel."""
        return self._frame.channels[channel].start + self._tracks[channel].places[wire]

    def _of_gutters(self) -> _Extents:
        extents: _Extents = defaultdict(dict)
        for wire, route in self._all():
            for before, channel, after in zip(
                route.channels, route.channels[1:], route.channels[2:], strict=False
            ):
                if channel.is_vertical:
                    ends = (self._frame.channels[one].middle for one in (before, after))
                    _extend(extents[channel], wire, *ends)
        return extents

    def _of_rows(self) -> _Extents:
        extents: _Extents = defaultdict(dict)
        for wire, route in self._all():
            for channel, piece in self._pieces(wire, route):
                _extend(extents[channel], wire, piece.low, piece.high)
        return extents

    def _pieces(self, wire: int, route: Route) -> Iterator[tuple[Channel, Extent]]:
        """Yield the level pieces of a route."""
        across = self._across(wire, route)
        for channel, ends in zip(route.channels[::2], pairwise(across), strict=True):
            yield channel, Extent(min(ends), max(ends))

    def _across(self, wire: int, route: Route) -> Sequence[float]:
        """Return where a route runs up or down: at its ports, and in gutters."""
        start, end = (self._ports[port] for port in _ports_of(wire, route))
        return [start, *(self._at(one, wire) for one in route.channels[1::2]), end]

    def _all(self) -> Iterator[tuple[int, Route]]:
        for wire, routes in enumerate(self._routes):
            for route in routes:
                yield wire, route

    def _place_ports(self) -> Mapping[_Port, float]:
        """Return where each wire leaves or enters a side of a cell, by where it goes."""
        sides: dict[tuple[str, Channel], dict[_Port, float]] = defaultdict(dict)
        for wire, route in self._all():
            next_x = [self._frame.cells[cell].centre[0] for cell in reversed(route.pair)]
            if len(route.channels) > 1:
                next_x = [self._at(route.channels[n], wire) for n in (1, -2)]
            for port, x in zip(_ports_of(wire, route), next_x, strict=True):
                sides[port[0], port[1]][port] = x
        found = {}
        for (cell, channel), ports in sides.items():
            rect = self._frame.cells[cell]
            is_above = self._frame.channels[channel].start < rect.y
            pitch = (rect.width - 2 * _ASIDE) / (len(ports) + 1)
            for place, port in enumerate(sorted(ports, key=lambda one: (ports[one], one)), 1):
                found[port] = rect.x + place * pitch + (2 * _ASIDE if is_above else 0)
        return found

    def _choose_labels(self) -> Mapping[int, Channel]:
        """Choose each label's channel, where its wire is longest, and make room for it there."""
        chosen = {}
        for wire in range(min(len(self._wires), MAX_LABELS)):
            channel, longest = max(
                (piece for route in self._routes[wire] for piece in self._pieces(wire, route)),
                key=lambda one: one[1].high - one[1].low,
            )
            low, high = self._room(channel)
            width = min(label_width(self._wires[wire]), high - low)
            middle = min(max(longest.middle, low + width / 2), high - width / 2)
            whole = self._extents[channel][wire]
            self._extents[channel][wire] = Extent(
                min(whole.low, middle - width / 2),
                max(whole.high, middle + width / 2),
                Label(middle, width),
            )
            chosen[wire] = channel
        return chosen

    def _room(self, channel: Channel) -> tuple[float, float]:
        """Return the ends of a row or band channel."""
        if channel.kind is Kind.BAND:
            return 0.0, self._frame.width
        rect = self._frame.clusters[channel.group]
        return rect.x + PAD, rect.right - PAD

    def _line(self, wire: int, route: Route) -> Line:
        across = self._across(wire, route)
        down = [self._at(channel, wire) for channel in route.channels[::2]]
        points = [(across[0], self._edge(route.pair[0], down[0]))]
        for place, y in enumerate(down):
            points += [(across[place], y), (across[place + 1], y)]
        points.append((across[-1], self._edge(route.pair[1], down[-1])))
        return without_repetition(points)

    def _edge(self, cell: str, y: float) -> float:
        """Return the side of a cell that faces a height."""
        rect = self._frame.cells[cell]
        return rect.y if y < rect.y else rect.bottom

    def _label(self, wire: int) -> Rect | None:
        channel = self._labels.get(wire)
        if channel is None:
            return None
        label = self._extents[channel][wire].label
        assert label is not None
        top = self._at(channel, wire) - LABEL_SIZE / 2
        return Rect(label.middle - label.width / 2, top, label.width, LABEL_SIZE)


def label_width(wire: Wire) -> float:
    """Return the width that a label needs."""
    return max(width_of(wire.name, BOLD), width_of("0" * LOAD_LENGTH, SMALL))


def _ports_of(wire: int, route: Route) -> tuple[_Port, _Port]:
    start, end = route.pair
    return (start, route.channels[0], wire, True), (end, route.channels[-1], wire, False)


def _extend(extents: dict[int, Extent], wire: int, one: float, other: float) -> None:
    known = extents.get(wire, Extent(one, one))
    extents[wire] = Extent(min(known.low, one, other), max(known.high, one, other))
