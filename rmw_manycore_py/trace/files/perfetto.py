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
_TIMESTAMP = b"\x40"  # of message TracePacket: field 8, a varint
_TRACK_EVENT = 11  # of message TracePacket
# Of message TrackEvent: fields 30, a varint; 47 and 48, of 8 bytes.
_COUNTER_VALUE, _FLOW, _LAST_OF_FLOW = b"\xf0\x01", b"\xf9\x02", b"\x81\x03"
_ANNOTATION = 4  # of message TrackEvent
_UINT_VALUE, _STRING_VALUE = b"\x18", 6  # of message DebugAnnotation: field 3, a varint
_CLEARED, _NEEDED = 1, 2  # SequenceFlags


def write(trace: Trace, file: BinaryIO) -> None:
    """Write the events themselves for `read`, then tracks, slices, flows and counters."""
    protos = _protos()
    own = _field(_OWN_FIELD, to_text(trace).encode())
    file.write(_field(_PACKET, own))
    for packet in _Packets(protos, trace).all():
        file.write(_field(_PACKET, packet))
    file.write(_end())


def read(content: bytes, path: Path) -> Trace:
    """Return the trace that `write` put into a file; needs no extra."""
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


def _protos() -> Any:
    try:
        from perfetto.protos.perfetto.trace import perfetto_trace_pb2
    except ImportError as error:
        raise ManycoreError(
            "Perfetto's format needs the package perfetto: pip install 'rmw-manycore[trace]'; "
            "ui.perfetto.dev opens a .json as well"
        ) from error
    return perfetto_trace_pb2


_SMALL = tuple(bytes((n,)) for n in range(0x80))


def _varint(number: int) -> bytes:
    if number < 0x80:
        return _SMALL[number]
    if number < 0x4000:
        return bytes((number & 0x7F | 0x80, number >> 7))
    out = bytearray()
    while number > 0x7F:
        out.append(number & 0x7F | 0x80)
        number >>= 7
    out.append(number)
    return bytes(out)


def _time(n: int) -> bytes:
    """Return a varint of 9 bytes, some of them perhaps nothing but a continuation: it is quick."""
    low = (n & 0x7F | 0x80, n >> 7 & 0x7F | 0x80, n >> 14 & 0x7F | 0x80, n >> 21 & 0x7F | 0x80)
    high = (n >> 28 & 0x7F | 0x80, n >> 35 & 0x7F | 0x80, n >> 42 & 0x7F | 0x80)
    return bytes((*low, *high, n >> 49 & 0x7F | 0x80, n >> 56 & 0x7F))


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


def _end() -> bytes:
    """Return the last packet, which a truncated file lacks."""
    return _field(_PACKET, _field(_OWN_FIELD, b"end"))


class _Packets:
    """Makes the packets of one trace."""

    def __init__(self, protos: Any, trace: Trace) -> None:
        self._protos = protos
        self._trace = trace
        self._names: dict[str, int] = {}
        self._annotations: dict[str, bytes] = {}
        self._heads: dict[tuple[int, int, str | None], bytes] = {}
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

    def all(self) -> Iterator[bytes]:
        """Yield each packet, serialized."""
        first = self._protos.TracePacket(
            trusted_packet_sequence_id=_SEQUENCE, sequence_flags=_CLEARED
        )
        first.trace_packet_defaults.timestamp_clock_id = _MONOTONIC
        first.first_packet_on_sequence = True
        yield first.SerializeToString()
        parents: dict[tuple[int, str], int] = {}
        index = 0
        for process in self._trace.processes:
            for key, name, above in _place(process):
                if key not in parents:
                    parents[key], packet = self._track(name, above and parents[above])
                    yield packet
            core = parents[process.cluster, core_name(process)]
            node, packet = self._track(process_name(self._trace, process), core)
            yield packet
            for thread in process.threads:
                track, packet = self._track(f"{thread.name} ({thread.tid})", node)
                yield packet
                yield from self._thread(index, thread, track)
                index += 1
        yield from self._counters()

    def _track(self, name: str, parent: int | None, counts: bool = False) -> tuple[int, bytes]:
        self._last_track += 1
        packet = self._protos.TracePacket(trusted_packet_sequence_id=_SEQUENCE)
        packet.track_descriptor.uuid = self._last_track
        packet.track_descriptor.name = name
        if parent is not None:
            packet.track_descriptor.parent_uuid = parent
        if counts:
            packet.track_descriptor.counter.SetInParent()
        return self._last_track, packet.SerializeToString()

    def _head(self, kind: int, track: int, name: str | None = None) -> bytes:
        """Return what all packets of a kind, track and name have in common.

        Fields may stand in any order, and parts of a message are merged, so a packet is this, its
        time, and what else it has of its own.
        """
        head = self._heads.get((kind, track, name))
        if head is not None:
            return head
        packet = self._protos.TracePacket(
            trusted_packet_sequence_id=_SEQUENCE, sequence_flags=_NEEDED
        )
        packet.track_event.type = kind
        packet.track_event.track_uuid = track
        if name is not None:
            known = self._names.get(name)
            if known is None:
                known = self._names[name] = len(self._names) + 1
                packet.interned_data.event_names.add(iid=known, name=name)
            packet.track_event.name_iid = known
        head = bytes(packet.SerializeToString())
        packet.ClearField("interned_data")
        self._heads[kind, track, name] = packet.SerializeToString() + _TIMESTAMP
        return head + _TIMESTAMP

    def _thread(self, index: int, thread: Thread, track: int) -> Iterator[bytes]:
        """Open and close slices in the order in which they lie in each other."""
        end = self._head(self._types.TYPE_SLICE_END, track)
        open_ends: list[int] = []
        slices = slices_of(self._trace, thread)
        slices.sort(key=lambda one: (one.begin_ns, -one.end_ns))
        for one in slices:
            while open_ends and open_ends[-1] <= one.begin_ns:
                yield end + _time(open_ends.pop())
            kind = self._types.TYPE_INSTANT if one.is_instant else self._types.TYPE_SLICE_BEGIN
            head = self._head(kind, track, one.name)
            yield head + _time(one.begin_ns) + self._rest(index, one)
            if not one.is_instant:
                inside = open_ends[-1] if open_ends else one.end_ns
                open_ends.append(min(one.end_ns, inside))
        while open_ends:
            yield end + _time(open_ends.pop())

    def _rest(self, index: int, one: Slice) -> bytes:
        if not one.arguments and one.record is None:
            return b""
        parts = [self._annotation(key, value) for key, value in one.arguments.items()]
        if one.record is not None:
            flows = self._begins.get((one.category, index, one.record), ())
            parts += [_FLOW + flow.to_bytes(8, "little") for flow in flows]
            if one.category == "take":
                ending = self._ends.get((index, one.begin_ns, one.record))
                if ending is not None:
                    parts.append(_LAST_OF_FLOW + ending.to_bytes(8, "little"))
        return _field(_TRACK_EVENT, b"".join(parts))

    def _annotation(self, key: str, value: int | str) -> bytes:
        head = self._annotations.get(key)
        if head is None:
            message = self._protos.DebugAnnotation(name=key)
            head = self._annotations[key] = message.SerializeToString()
        if isinstance(value, int):
            return _field(_ANNOTATION, head + _UINT_VALUE + _varint(value))
        return _field(_ANNOTATION, head + _field(_STRING_VALUE, value.encode()))

    def _counters(self) -> Iterator[bytes]:
        for counter in counters_of(self._trace):
            track, packet = self._track(counter.name, None, counts=True)
            yield packet
            head = self._head(self._types.TYPE_COUNTER, track)
            for time_ns, value in counter.samples:
                event = _COUNTER_VALUE + _varint(int(value))
                yield head + _time(time_ns) + _field(_TRACK_EVENT, event)


def _place(
    process: Process,
) -> tuple[tuple[tuple[int, str], str, tuple[int, str] | None], ...]:
    """Return the tracks above a process: key, name and key of the one above."""
    cluster = (process.cluster, "")
    core = core_name(process)
    return (cluster, f"cluster {process.cluster}", None), ((process.cluster, core), core, cluster)
