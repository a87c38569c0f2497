# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Scans a file without an index, e.g. an unfinished one."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import IO, Any

from mcap.exceptions import RecordLengthLimitExceeded
from mcap.records import Channel, Chunk, ChunkIndex, DataEnd, Footer, Message, Schema, Statistics
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.summary import Summary
from mcap.writer import MCAP0_MAGIC

from rmw_manycore_py.errors import what_is_wrong

_UNFINISHED = "it was not finished"


@dataclass(frozen=True)
class Scanned:
    """Contents up to the end, or to where the file is truncated or damaged."""

    summary: Summary
    end: int  # offset after the last intact record
    fault: str  # "" if the file is intact


def scan(file: IO[bytes], size_bytes: int) -> Scanned:
    """Read a file from its start, and index the complete chunks."""
    scanner = _Scanner()
    end = fault = None
    file.seek(-len(MCAP0_MAGIC), os.SEEK_END)
    if file.read() != MCAP0_MAGIC:
        fault = _UNFINISHED
    file.seek(0)
    try:
        reader = StreamReader(file, emit_chunks=True, record_size_limit=size_bytes)
        for record in reader.records:
            if isinstance(record, (DataEnd, Footer)):
                break
            scanner.add(record, end or 0, file.tell())
            end = file.tell()
    except RecordLengthLimitExceeded:  # a record longer than the file
        fault = _UNFINISHED
    except Exception as error:  # the library and its decoders do not document their errors
        fault = _UNFINISHED
        if file.tell() < size_bytes:
            fault = f"it is damaged after byte {end or 0} ({what_is_wrong(error)})"
    return Scanned(scanner.summary, end or 0, fault or "")


class _Scanner:
    def __init__(self) -> None:
        self.summary = Summary()
        self._counts: dict[int, int] = {}
        self._start_ns: int | None = None
        self._end_ns = 0
        self._count()

    def add(self, record: Any, start: int, end: int) -> None:
        """Add a record located between two offsets."""
        if isinstance(record, Chunk):
            inner = breakup_chunk(record, validate_crc=True)
            for one in inner:
                self._add(one)
            self.summary.chunk_indexes.append(_index(record, start, end))
        else:
            self._add(record)
        self._count()

    def _add(self, record: Any) -> None:
        if isinstance(record, Schema):
            self.summary.schemas[record.id] = record
        elif isinstance(record, Channel):
            self.summary.channels[record.id] = record
        elif isinstance(record, Message):
            self._counts[record.channel_id] = self._counts.get(record.channel_id, 0) + 1
            at_ns = record.log_time
            self._start_ns = at_ns if self._start_ns is None else min(self._start_ns, at_ns)
            self._end_ns = max(self._end_ns, at_ns)

    def _count(self) -> None:
        self.summary.statistics = Statistics(
            attachment_count=0,
            channel_count=len(self.summary.channels),
            channel_message_counts=self._counts,
            chunk_count=len(self.summary.chunk_indexes),
            message_count=sum(self._counts.values()),
            message_start_time=self._start_ns or 0,
            message_end_time=self._end_ns,
            metadata_count=0,
            schema_count=len(self.summary.schemas),
        )


def _index(chunk: Chunk, start: int, end: int) -> ChunkIndex:
    return ChunkIndex(
        chunk_length=end - start,
        chunk_start_offset=start,
        compression=chunk.compression,
        compressed_size=len(chunk.data),
        message_end_time=chunk.message_end_time,
        message_index_length=0,
        message_index_offsets={},
        message_start_time=chunk.message_start_time,
        uncompressed_size=chunk.uncompressed_size,
    )
