# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Perfetto's protobuf, for ui.perfetto.dev and its SQL. Writing needs the extra `trace`."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.trace.events import Process, Thread, Trace
from rmw_manycore_py.trace.files.embedded import from_text, to_text, wrong
from rmw_manycore_py.trace.files.tracks import core_name, counters_of, process_name
from rmw_manycore_py.trace.flows import Flow, flows_of
from rmw_manycore_py.trace.slices import Slice, slices_of

_PACKET = 1  # of message Trace
# Of message TracePacket: a field that Perfetto does not know, and passes over.
_OWN_FIELD = 98765
_LENGTH_DELIMITED = 2
_SEQUENCE = 1
_MONOTONIC = 3  # BuiltinClock
_CLEARED, _NEEDED = 1, 2  # SequenceFlags


def write(trace: Trace, file: BinaryIO) -> None:
    """Write the events themselves for `read`, then tracks, slices, flows and counters."""
    protos = _protos()
    own = _field(_OWN_FIELD, to_text(trace).encode())
    file.write(_field(_PACKET, own))
    for packet in _Packets(protos, trace).all():
        file.write(_field(_PACKET, packet.SerializeToString()))


def read(content: bytes, path: Path) -> Trace:
    """Return the trace that `write` put into a file; needs no extra."""
    try:
        number, packet, _ = _next_field(content, 0)
        own, text, _ = _next_field(packet, 0)
    except (IndexError, ValueError) as error:
        raise wrong(path, "", "a whole trace", "its beginning only, or no protobuf") from error
    if (number, own) != (_PACKET, _OWN_FIELD):
        raise wrong(path, "", "a trace of manycore trace save", "a trace of another program")
    return from_text(text.decode(errors="replace"), path)


def _protos() -> Any:
    try:
        from perfetto.protos.perfetto.trace import perfetto_trace_pb2
    except ImportError as error:
        raise ManycoreError(
            "Perfetto's format needs the package perfetto: pip install 'rmw-manycore[trace]'; "
            "ui.perfetto.dev opens a .json as well"
        ) from error
    return perfetto_trace_pb2


def _varint(number: int) -> bytes:
    out = bytearray()
    while number > 0x7F:
        out.append(number & 0x7F | 0x80)
        number >>= 7
    out.append(number)
    return bytes(out)


def _field(number: int, data: bytes) -> bytes:
    return _varint(number << 3 | _LENGTH_DELIMITED) + _varint(len(data)) + data


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


class _Packets:
    """Makes the packets of one trace."""

    def __init__(self, protos: Any, trace: Trace) -> None:
        self._protos = protos
        self._trace = trace
        self._names: dict[str, int] = {}
        self._last_track = 0
        self._types = protos.TrackEvent
        flows = flows_of(trace).flows
        self._begins: dict[Any, list[int]] = defaultdict(list)
        self._ends: dict[Any, int] = {}
        for number, flow in enumerate(flows, 1):
            self._note(number, flow)

    def _note(self, number: int, flow: Flow) -> None:
        self._begins["publish", flow.write.thread, flow.record].append(number)
        if flow.receive is not None:
            self._begins["receive", flow.receive.thread, flow.record].append(number)
        self._ends[flow.claim.thread, flow.claim.time_ns, flow.record] = number

    def all(self) -> Iterator[Any]:
        first = self._protos.TracePacket(
            trusted_packet_sequence_id=_SEQUENCE, sequence_flags=_CLEARED
        )
        first.trace_packet_defaults.timestamp_clock_id = _MONOTONIC
        first.first_packet_on_sequence = True
        yield first
        clusters: dict[int, int] = {}
        cores: dict[tuple[int, str], int] = {}
        index = 0
        for process in self._trace.processes:
            yield from self._parents(process, clusters, cores)
            core = cores[process.cluster, core_name(process)]
            node, packet = self._track(process_name(self._trace, process), core)
            yield packet
            for thread in process.threads:
                track, packet = self._track(f"{thread.name} ({thread.tid})", node)
                yield packet
                yield from self._thread(index, thread, track)
                index += 1
        yield from self._counters()

    def _parents(
        self, process: Process, clusters: dict[int, int], cores: dict[tuple[int, str], int]
    ) -> Iterator[Any]:
        if process.cluster not in clusters:
            clusters[process.cluster], packet = self._track(f"cluster {process.cluster}")
            yield packet
        key = (process.cluster, core_name(process))
        if key not in cores:
            cores[key], packet = self._track(key[1], clusters[process.cluster])
            yield packet

    def _track(self, name: str, parent: int | None = None) -> tuple[int, Any]:
        self._last_track += 1
        packet = self._protos.TracePacket(trusted_packet_sequence_id=_SEQUENCE)
        packet.track_descriptor.uuid = self._last_track
        packet.track_descriptor.name = name
        if parent is not None:
            packet.track_descriptor.parent_uuid = parent
        return self._last_track, packet

    def _event(self, kind: int, time_ns: int, track: int) -> Any:
        packet = self._protos.TracePacket(
            timestamp=time_ns, trusted_packet_sequence_id=_SEQUENCE, sequence_flags=_NEEDED
        )
        packet.track_event.type = kind
        packet.track_event.track_uuid = track
        return packet

    def _name(self, packet: Any, name: str) -> None:
        known = self._names.get(name)
        if known is None:
            known = self._names[name] = len(self._names) + 1
            packet.interned_data.event_names.add(iid=known, name=name)
        packet.track_event.name_iid = known

    def _thread(self, index: int, thread: Thread, track: int) -> Iterator[Any]:
        """Open and close slices in the order in which they lie in each other."""
        open_ends: list[int] = []
        slices = slices_of(self._trace, thread)
        for one in sorted(slices, key=lambda one: (one.begin_ns, -one.end_ns)):
            while open_ends and open_ends[-1] <= one.begin_ns:
                yield self._event(self._types.TYPE_SLICE_END, open_ends.pop(), track)
            yield self._begin(index, one, track)
            if not one.is_instant:
                open_ends.append(min([one.end_ns, *open_ends[-1:]]))
        while open_ends:
            yield self._event(self._types.TYPE_SLICE_END, open_ends.pop(), track)

    def _begin(self, index: int, one: Slice, track: int) -> Any:
        kind = self._types.TYPE_INSTANT if one.is_instant else self._types.TYPE_SLICE_BEGIN
        packet = self._event(kind, one.begin_ns, track)
        self._name(packet, one.name)
        event = packet.track_event
        for key, value in one.arguments.items():
            annotation = event.debug_annotations.add(name=key)
            if isinstance(value, int):
                annotation.uint_value = value
            else:
                annotation.string_value = str(value)
        if one.record is not None:
            event.flow_ids.extend(self._begins.get((one.category, index, one.record), ()))
            end = self._ends.get((index, one.begin_ns, one.record))
            if end is not None and one.category == "take":
                event.terminating_flow_ids.append(end)
        return packet

    def _counters(self) -> Iterator[Any]:
        for counter in counters_of(self._trace):
            track, packet = self._track(counter.name)
            packet.track_descriptor.counter.SetInParent()
            yield packet
            for time_ns, value in counter.samples:
                packet = self._event(self._types.TYPE_COUNTER, time_ns, track)
                packet.track_event.counter_value = int(value)
                yield packet
