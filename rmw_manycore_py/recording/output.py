# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Writes a recording: MCAP chunks, each complete on disk before the next."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from mcap.writer import CompressionType, Writer

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.recording.definitions import Schema
from rmw_manycore_py.recording.metadata import Span, TopicRow, information
from rmw_manycore_py.recording.offers import profiles_text
from rmw_manycore_py.recording.plain_yaml import dump

# Maximum memory for reading one message.
CHUNK_BYTES = 1 << 20
_SEQUENCE_MASK = 0xFFFFFFFF


class Output:
    """Writes messages; `flush` ends a chunk. After a kill, complete chunks remain."""

    def __init__(self, path: Path, compression: str = "none") -> None:
        """Create the file; it must not exist.

        :raises ManycoreError: if it cannot be created.
        """
        self.path = path
        self._file = _ChunkFile(path)
        self._writer = Writer(
            self._file,  # type: ignore[arg-type]
            chunk_size=CHUNK_BYTES,
            compression=CompressionType[compression.upper()],
        )
        self._channels: dict[str, int] = {}
        self._schemas: dict[tuple[str, Schema], int] = {}
        self._start_ns, self._end_ns = 0, 0
        self.messages = self.whole_messages = 0  # total, and in chunks on disk
        try:
            self._writer.start("ros2")
            self._writer.flush()
        except OSError as error:
            self._file.close()
            raise _unwritable(path, error) from error

    def write(
        self, row: TopicRow, recorded_ns: int, published_ns: int, number: int, data: bytes
    ) -> None:
        """Write a message of a topic."""
        channel = self._channels.get(row.name)
        if channel is None:
            channel = self._add(row)
        if self._file.tell() != self._file.whole:  # the previous message completed a chunk
            self._file.flush()
            self.whole_messages = self.messages
        self._writer.add_message(channel, recorded_ns, data, published_ns, number & _SEQUENCE_MASK)
        row.messages += 1
        self._start_ns = min(self._start_ns, recorded_ns) if self.messages else recorded_ns
        self._end_ns = max(self._end_ns, recorded_ns)
        self.messages += 1

    def _add(self, row: TopicRow) -> int:
        metadata = {
            "offered_qos_profiles": profiles_text(row.offers),
            "topic_type_hash": row.type_hash,
        }
        channel = self._writer.register_channel(row.name, row.encoding, self._schema(row), metadata)
        self._channels[row.name] = channel
        return channel

    def _schema(self, row: TopicRow) -> int:
        key = row.type, row.schema
        if key not in self._schemas:
            self._schemas[key] = self._writer.register_schema(
                row.type, row.schema.encoding, row.schema.text.encode()
            )
        return self._schemas[key]

    def flush(self) -> None:
        """Write all pending messages."""
        self._writer.flush()
        self.whole_messages = self.messages

    @property
    def size_bytes(self) -> int:
        """Return the current file size."""
        return self._file.tell()

    def finish(self, rows: list[TopicRow]) -> dict[str, Any]:
        """Write topics without messages, and the index; return the contents of metadata.yaml."""
        for row in rows:
            if row.name not in self._channels:
                self._add(row)
        span = Span(self.messages, self._start_ns, self._end_ns)
        found = information(self.path.name, rows, span)
        self._writer.flush()
        self._writer.add_metadata("rosbag2", {"serialized_metadata": dump(found)})
        self._writer.finish()
        self._file.close()
        return found

    def give_up(self) -> None:
        """Truncate to complete chunks after a failed write."""
        self._file.cut()
        self._file.close()


def _unwritable(path: Path, error: OSError) -> ManycoreError:
    return ManycoreError(f"{path}: cannot be written: {error.strerror}", EXIT_BAD_INPUT)


class _ChunkFile:
    """File for `Writer`: complete writes, or an error after which `cut` removes the chunk."""

    def __init__(self, path: Path) -> None:
        try:
            self._descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
        except OSError as error:
            raise _unwritable(path, error) from error
        self._size = self.whole = 0

    def write(self, data: bytes) -> int:
        """Write all data."""
        left = memoryview(data)
        while left:
            written = os.write(self._descriptor, left)
            left = left[written:]
            self._size += written
        return self._size

    def tell(self) -> int:
        """Return the offset of the next write."""
        return self._size

    def flush(self) -> None:
        """Mark everything written as complete."""
        self.whole = self._size

    def cut(self) -> None:
        """Discard everything written since the last flush."""
        os.ftruncate(self._descriptor, self.whole)
        self._size = self.whole

    def close(self) -> None:
        """Close the file."""
        os.close(self._descriptor)
