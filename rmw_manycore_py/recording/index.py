# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Index of an MCAP file: its own if that is complete, else one made by a scan."""

from __future__ import annotations

import struct
from array import array
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from typing import IO, NamedTuple

import numpy as np
import numpy.typing as npt
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.reader import SeekingReader
from mcap.records import Channel, Chunk, ChunkIndex, Message, Metadata, Schema, Statistics
from mcap.stream_reader import breakup_chunk
from mcap.summary import Summary
from mcap.writer import MCAP0_MAGIC

from rmw_manycore_py.errors import what_is_wrong

UNFINISHED = "it was not finished"
_HEAD = struct.Struct("<BQ")  # opcode and length of a record


@dataclass
class BareMessages:
    """Messages outside of chunks: their times (ns), channels, and the offsets of their records."""

    times: array[int] = field(default_factory=lambda: array("Q"))
    channels: array[int] = field(default_factory=lambda: array("H"))
    offsets: array[int] = field(default_factory=lambda: array("Q"))

    def in_time_order(self) -> npt.NDArray[np.int64]:
        """Return the indices of the messages, in the order of their times."""
        return np.argsort(np.frombuffer(self.times, np.uint64), kind="stable")

    def read(self, file: IO[bytes], at: int) -> Message:
        """Read one of them."""
        content = content_at(file, self.offsets[at])
        found: Message = Message.read(ReadDataStream(BytesIO(content)), len(content))
        return found


@dataclass
class Index:
    """Contents of a file up to its end, or to where it is cut or damaged."""

    summary: Summary = field(default_factory=Summary)
    bare: BareMessages = field(default_factory=BareMessages)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)  # by name
    fault: str = ""  # empty if the file is intact

    @property
    def statistics(self) -> Statistics:
        """Return the numbers of messages and their times."""
        assert self.summary.statistics is not None
        return self.summary.statistics


class _Place(NamedTuple):
    """A record; the file is at its content."""

    opcode: int
    start: int
    length: int  # of the content

    @property
    def end(self) -> int:
        return self.start + _HEAD.size + self.length


def content_at(file: IO[bytes], start: int) -> bytes:
    """Return the content of the record at an offset."""
    file.seek(start)
    _, length = _HEAD.unpack(file.read(_HEAD.size))
    return file.read(length)


def index_of(file: IO[bytes], size_bytes: int) -> Index:
    """Return the index of a file that begins like an MCAP file."""
    summary = _own_summary(file, size_bytes)
    return _own(file, size_bytes, summary) or _scanned(file, size_bytes, summary)


def _own_summary(file: IO[bytes], size_bytes: int) -> Summary:
    """Return the file's own summary; an empty one if there is none."""
    file.seek(0)
    try:
        found = SeekingReader(file, record_size_limit=size_bytes).get_summary()
    except Exception:  # the end of a cut file may be misread
        found = None
    return found or Summary()


def _own(file: IO[bytes], size_bytes: int, summary: Summary) -> Index | None:
    """Return the file's own index; None if it is incomplete.

    A summary may lack schemas, channels, statistics, and the index of a chunk, and messages may be
    outside of chunks. Reads only the records between the chunks.
    """
    if not _is_complete(summary):
        return None
    try:
        index = Index(summary)
        ends = {
            one.chunk_start_offset: one.chunk_start_offset
            + one.chunk_length
            + one.message_index_length
            for one in summary.chunk_indexes
        }
        for place in _places(file, size_bytes, ends):
            if place.opcode in (Opcode.MESSAGE, Opcode.CHUNK):
                return None
            _add(file, place, index, _Counts())  # for metadata; the rest is in the summary
    except Exception:  # the summary is damaged
        return None
    return index


def _is_complete(summary: Summary) -> bool:
    statistics, channels = summary.statistics, summary.channels
    return (
        statistics is not None
        and len(channels) == statistics.channel_count
        and {channel.schema_id for channel in channels.values()} <= {0, *summary.schemas}
        and len(summary.chunk_indexes) == statistics.chunk_count
        and sum(statistics.channel_message_counts.values()) == statistics.message_count
    )


def _places(
    file: IO[bytes], size_bytes: int, skipped: dict[int, int] | None = None
) -> Iterator[_Place]:
    """Yield the records of the data section.

    :param skipped: ends of ranges to skip, by their starts; emptied.
    :raises EOFError: if the file ends within the section.
    """
    at = len(MCAP0_MAGIC)
    while True:
        if skipped and at in skipped:
            at = skipped.pop(at)
            continue
        file.seek(at)
        head = file.read(_HEAD.size)
        if len(head) < _HEAD.size:
            raise EOFError
        opcode, length = _HEAD.unpack(head)
        place = _Place(opcode, at, length)
        if place.end > size_bytes:
            raise EOFError
        if opcode in (Opcode.DATA_END, Opcode.FOOTER):
            return
        yield place
        at = place.end


def _scanned(file: IO[bytes], size_bytes: int, summary: Summary) -> Index:
    """Index the complete records; the summary may add topics without messages."""
    index, counts = Index(), _Counts()
    index.summary.schemas, index.summary.channels = summary.schemas, summary.channels
    end = len(MCAP0_MAGIC)
    try:
        for place in _places(file, size_bytes):
            _add(file, place, index, counts)
            end = place.end
        file.seek(-len(MCAP0_MAGIC), 2)
        if file.read() != MCAP0_MAGIC:
            index.fault = UNFINISHED
    except EOFError:  # also a record longer than the file
        index.fault = UNFINISHED
    except Exception as error:  # the library and its decoders do not document their errors
        index.fault = f"it is damaged after byte {end} ({what_is_wrong(error)})"
    index.summary.statistics = counts.statistics(index.summary)
    return index


def _add(file: IO[bytes], place: _Place, index: Index, counts: _Counts) -> None:
    stream = ReadDataStream(BytesIO(file.read(place.length)))
    if place.opcode == Opcode.CHUNK:
        chunk = Chunk.read(stream)
        for record in breakup_chunk(chunk, validate_crc=True):
            _add_record(record, index, counts)
        index.summary.chunk_indexes.append(_chunk_index(chunk, place))
    elif place.opcode == Opcode.SCHEMA:
        _add_record(Schema.read(stream), index, counts)
    elif place.opcode == Opcode.CHANNEL:
        _add_record(Channel.read(stream), index, counts)
    elif place.opcode == Opcode.MESSAGE:
        message = Message.read(stream, place.length)
        _add_record(message, index, counts)
        index.bare.times.append(message.log_time)
        index.bare.channels.append(message.channel_id)
        index.bare.offsets.append(place.start)
    elif place.opcode == Opcode.METADATA:
        found = Metadata.read(stream)
        index.metadata[found.name] = dict(found.metadata)


def _add_record(record: object, index: Index, counts: _Counts) -> None:
    if isinstance(record, Schema):
        index.summary.schemas[record.id] = record
    elif isinstance(record, Channel):
        index.summary.channels[record.id] = record
    elif isinstance(record, Message):
        if record.channel_id not in index.summary.channels:
            raise ValueError(f"a message of the unknown channel {record.channel_id}")
        counts.add(record)


class _Counts:
    """Numbers of messages and their times."""

    def __init__(self) -> None:
        self._channels: dict[int, int] = {}
        self._start_ns: int | None = None
        self._end_ns = 0

    def add(self, message: Message) -> None:
        self._channels[message.channel_id] = self._channels.get(message.channel_id, 0) + 1
        at_ns = message.log_time
        self._start_ns = at_ns if self._start_ns is None else min(self._start_ns, at_ns)
        self._end_ns = max(self._end_ns, at_ns)

    def statistics(self, summary: Summary) -> Statistics:
        return Statistics(
            attachment_count=0,
            channel_count=len(summary.channels),
            channel_message_counts=self._channels,
            chunk_count=len(summary.chunk_indexes),
            message_count=sum(self._channels.values()),
            message_start_time=self._start_ns or 0,
            message_end_time=self._end_ns,
            metadata_count=0,
            schema_count=len(summary.schemas),
        )


def _chunk_index(chunk: Chunk, place: _Place) -> ChunkIndex:
    return ChunkIndex(
        chunk_length=place.end - place.start,
        chunk_start_offset=place.start,
        compression=chunk.compression,
        compressed_size=len(chunk.data),
        message_end_time=chunk.message_end_time,
        message_index_length=0,
        message_index_offsets={},
        message_start_time=chunk.message_start_time,
        uncompressed_size=chunk.uncompressed_size,
    )
