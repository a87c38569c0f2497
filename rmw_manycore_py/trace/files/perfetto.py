# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Perfetto's protobuf, for ui.perfetto.dev and its SQL. Writing requires the extra `trace`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.errors.missing_library import PERFETTO, require
from rmw_manycore_py.trace.counters import counters_of
from rmw_manycore_py.trace.events import Process, Trace
from rmw_manycore_py.trace.files import packets
from rmw_manycore_py.trace.files.embedded import from_text, to_text, wrong
from rmw_manycore_py.trace.files.packets import Part, Rows, field
from rmw_manycore_py.trace.flows import flows_of
from rmw_manycore_py.trace.names import core_name, process_name
from rmw_manycore_py.trace.pairs import first_of, groups_of
from rmw_manycore_py.trace.slices import ARGUMENTS, SLICE, Slices, What, name_of, slices_of

_PACKET = 1  # of message Trace
# Field of TracePacket that Perfetto does not know and skips.
_OWN_FIELD = 98765
_LENGTH_DELIMITED = 2
_SEQUENCE = 1
_MONOTONIC = 3  # BuiltinClock
_CLEARED = 1  # SequenceFlags


def write(trace: Trace, file: BinaryIO) -> None:
    """Write the events for `read`, then tracks, slices, flows and counters."""
    protos = require(PERFETTO)
    own = field(_OWN_FIELD, to_text(trace).encode())
    file.write(field(_PACKET, own))
    for some in _Writer(protos, trace).all():
        file.write(some)
    file.write(_end())


def read(content: bytes, path: Path) -> Trace:
    """Return the trace written by `write`; does not require the extra."""
    try:
        number, packet, _ = _next_field(content, 0)
        own, text, _ = _next_field(packet, 0)
    except (IndexError, ValueError) as error:
        raise wrong(path, "", "a whole trace", "its beginning only, or no protobuf") from error
    if (number, own) != (_PACKET, _OWN_FIELD):
        raise wrong(path, "", "a trace of manycore trace save", "a trace of another program")
    if not content.endswith(_end()):
        raise wrong(path, "", "a whole trace", "its beginning only")
    return from_text(text.decode(errors="replace"), path)


def _next_varint(data: bytes, at: int) -> tuple[int, int]:
    number = shift = 0
    while True:
        byte = data[at]
        at += 1
        number |= (byte & 0x7F) << shift
        shift += 7
        if byte < 0x80:
            return number, at


def _next_field(data: bytes, at: int) -> tuple[int, bytes, int]:
    tag, at = _next_varint(data, at)
    length, at = _next_varint(data, at)
    if tag & 7 != _LENGTH_DELIMITED or at + length > len(data):
        raise ValueError("not a whole field")
    return tag >> 3, data[at : at + length], at + length


def _end() -> bytes:
    """Return the last packet; it is missing in a truncated file."""
    return field(_PACKET, field(_OWN_FIELD, b"end"))


class _Writer:
    """Builds the packets of a trace: tracks and names with package perfetto, the rest in numpy."""

    def __init__(self, protos: Any, trace: Trace) -> None:
        self._protos = protos
        self._trace = trace
        self._last_track = 0
        self._slices = [slices_of(thread) for _, thread in trace.threads()]
        self._flows = flows_of(trace).flows
        all_slices = np.concatenate([*self._slices, np.empty(0, SLICE)])
        names = groups_of((all_slices["what"], all_slices["endpoint"]))
        self._names = all_slices[np.unique(names, return_index=True)[1]]  # one slice per name
        ends = np.cumsum([len(one) for one in self._slices])
        self._name_ids = np.split(names + 1, ends)

    def all(self) -> Iterator[bytes]:
        """Yield packets in groups."""
        yield self._first()
        parents: dict[tuple[int, str], int] = {}
        index = 0
        for process in self._trace.processes:
            for key, name, above in _tracks_above(process):
                if key not in parents:
                    parents[key], packet = self._track(name, above and parents[above])
                    yield packet
            core = parents[process.cluster, core_name(process)]
            node, packet = self._track(process_name(self._trace, process), core)
            yield packet
            for thread in process.threads:
                track, packet = self._track(f"{thread.name} ({thread.tid})", node)
                yield packet
                yield self._thread(index, track)
                index += 1
        yield from self._counters()

    def _first(self) -> bytes:
        """Return the packet with the names of slices and the defaults of the sequence."""
        packet = self._protos.TracePacket(
            trusted_packet_sequence_id=_SEQUENCE, sequence_flags=_CLEARED
        )
        packet.trace_packet_defaults.timestamp_clock_id = _MONOTONIC
        packet.first_packet_on_sequence = True
        for iid, one in enumerate(self._names, 1):
            name = name_of(self._trace, int(one["what"]), int(one["endpoint"]))
            packet.interned_data.event_names.add(iid=iid, name=name)
        return field(_PACKET, packet.SerializeToString())

    def _track(self, name: str, parent: int | None, counts: bool = False) -> tuple[int, bytes]:
        self._last_track += 1
        packet = self._protos.TracePacket(trusted_packet_sequence_id=_SEQUENCE)
        packet.track_descriptor.uuid = self._last_track
        packet.track_descriptor.name = name
        if parent is not None:
            packet.track_descriptor.parent_uuid = parent
        if counts:
            packet.track_descriptor.counter.SetInParent()
        return self._last_track, field(_PACKET, packet.SerializeToString())

    def _thread(self, index: int, track: int) -> bytes:
        """Begin and end slices in nesting order."""
        slices = self._slices[index]
        order, times_ns = _opened_and_closed(slices)
        is_end = order < 0
        types = np.where(is_end, packets.SLICE_END, packets.SLICE_BEGIN)
        rows = np.flatnonzero(~is_end)  # rows of the slices, in order
        types[rows[slices["is_instant"]]] = packets.INSTANT
        parts = [packets.name(rows, self._name_ids[index]), *_arguments(slices, rows)]
        return packets.track_events(
            track, types, times_ns, [*parts, *self._flow_parts(index, slices, rows)]
        )

    def _flow_parts(self, index: int, slices: Slices, rows: Rows) -> Iterator[Part]:
        steps = (("write", What.PUBLISH), ("receive", What.RECEIVE), ("claim", What.TAKE))
        for step, what in steps:
            own = np.flatnonzero(self._flows[f"{step}_thread"] == index)
            flows, numbers = self._flows[own], own + 1
            among = np.flatnonzero(slices["what"] == what)
            table = [slices[key][among] for key in ("publisher", "number")]
            wanted = [flows[key] for key in ("publisher", "number")]
            if what == What.TAKE:
                table.append(slices["endpoint"][among])
                wanted.append(flows["subscription"])
            found = first_of(tuple(table), tuple(wanted))
            drawn = np.flatnonzero(found >= 0)
            through = rows[among[found[drawn]]]
            by_row = np.argsort(through, kind="stable")
            yield packets.flow(through[by_row], numbers[drawn][by_row], is_last=what == What.TAKE)

    def _counters(self) -> Iterator[bytes]:
        for counter in counters_of(self._trace):
            track, packet = self._track(counter.name, None, counts=True)
            yield packet
            types = np.full(len(counter.values), packets.COUNTER)
            value = packets.value(counter.values)
            yield packets.track_events(track, types, counter.times_ns, [value])


def _arguments(slices: Slices, rows: Rows) -> Iterator[Part]:
    for what, arguments in ARGUMENTS.items():
        own = slices["what"] == what
        for key, of in arguments:
            yield packets.number(rows[own], key, slices[of][own])
    yield packets.word(rows[~slices["is_end_known"]], "end", "unknown")


def _opened_and_closed(slices: Slices) -> tuple[NDArray[np.intp], NDArray[np.int64]]:
    """Return begins (slice index) and ends (-1) with their times, in order.

    An end always closes the slice opened last. At equal times, ends precede begins, except for
    slices of zero duration.
    """
    begins, ends = slices["begin_ns"], slices["end_ns"]
    lasting = np.flatnonzero(~slices["is_instant"])
    times_ns = np.concatenate([begins, ends[lasting]])
    takes_time = ends[lasting] > begins[lasting]
    rank = np.concatenate([np.ones(len(begins), np.int8), np.where(takes_time, 0, 2)])
    order = np.lexsort((rank, times_ns))
    which = np.concatenate([np.arange(len(begins)), np.full(len(lasting), -1)])
    return which[order], times_ns[order]


def _tracks_above(
    process: Process,
) -> tuple[tuple[tuple[int, str], str, tuple[int, str] | None], ...]:
    """Return the ancestor tracks of a process: key, name and parent key."""
    cluster = (process.cluster, "")
    core = core_name(process)
    return (cluster, f"cluster {process.cluster}", None), ((process.cluster, core), core, cluster)
