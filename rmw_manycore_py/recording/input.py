# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads one MCAP file."""

from __future__ import annotations

import heapq
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, NamedTuple

from mcap.reader import SeekingReader
from mcap.records import Channel, Schema
from mcap.summary import Summary
from mcap.writer import MCAP0_MAGIC

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError, what_is_wrong
from rmw_manycore_py.recording.compressed import unpacker_of
from rmw_manycore_py.recording.definitions import NO_SCHEMA
from rmw_manycore_py.recording.definitions import Schema as Definition
from rmw_manycore_py.recording.gaps import BusyTimes, busy_times
from rmw_manycore_py.recording.index import index_of
from rmw_manycore_py.recording.metadata import Span, TopicRow, own_metadata
from rmw_manycore_py.recording.offers import offers_in


class Recorded(NamedTuple):
    """A recorded message; times in ns since 1970."""

    topic: str
    recorded_ns: int
    data: bytes


class Input:
    """Reads a file by its index, or by one created by scanning."""

    def __init__(self, path: Path, described: Mapping[str, Any] | None = None) -> None:
        """Open a file.

        :param described: rosbag2's metadata of the recording, where it is not in the file.
        :raises ManycoreError: if it cannot be read, or is no MCAP file.
        """
        self.path = path
        try:
            self._file: IO[bytes] = path.open("rb")
            self.size_bytes = path.stat().st_size
        except (OSError, ValueError) as error:  # a null byte in a path of metadata.yaml
            reason = getattr(error, "strerror", None) or what_is_wrong(error)
            raise ManycoreError(f"{path}: cannot be read: {reason}", EXIT_BAD_INPUT) from error
        try:
            self._check_magic()
            self._index = index_of(self._file, self.size_bytes)
            self.described = {**own_metadata(self._index.metadata), **(described or {})}
            self._unpack = unpacker_of(path, self.described)
        except BaseException:
            self._file.close()
            raise
        self.remarks: list[str] = []

    def _check_magic(self) -> None:
        found = self._file.read(len(MCAP0_MAGIC))
        if found != MCAP0_MAGIC:
            what = "an empty file" if not found else f"{found!r}"
            raise ManycoreError(
                f"{self.path}: expected an MCAP file, which begins with {MCAP0_MAGIC!r}, found "
                f"{what}",
                EXIT_BAD_INPUT,
            )

    @property
    def fault(self) -> str:
        """Return why the file ends early; "" if it does not."""
        return self._index.fault

    @property
    def span(self) -> Span:
        """Return the number of messages, and the first and last time."""
        found = self._index.statistics
        return Span(found.message_count, found.message_start_time, found.message_end_time)

    def rows(self) -> list[TopicRow]:
        """Return the topics in channel order; a topic may have several channels."""
        return [self._row(channel) for channel in self._index.summary.channels.values()]

    def _row(self, channel: Channel) -> TopicRow:
        schema = self._index.summary.schemas.get(channel.schema_id)
        try:
            offers = offers_in(channel.metadata.get("offered_qos_profiles", ""))
        except ValueError as error:
            offers = []
            self.remarks.append(f"{self.path}: {channel.topic} has {error}: they are left out")
        return TopicRow(
            name=channel.topic,
            type=schema.name if schema else "",
            type_hash=channel.metadata.get("topic_type_hash", ""),
            schema=_definition(schema) if schema else NO_SCHEMA,
            offers=offers,
            encoding=channel.message_encoding,
            messages=self._index.statistics.channel_message_counts.get(channel.id, 0),
        )

    def messages(
        self, topics: Collection[str], start_ns: int = 0, end_ns: int | None = None
    ) -> Iterator[Recorded]:
        """Yield the messages of topics in time order.

        :raises ManycoreError: where the file is damaged.
        """
        with self._reported_damage():
            for found in heapq.merge(
                self._in_chunks(topics, start_ns, end_ns),
                self._outside_chunks(topics, start_ns, end_ns),
                key=lambda message: message.recorded_ns,
            ):
                yield found._replace(data=self._unpack(found.data))

    def _in_chunks(
        self, topics: Collection[str], start_ns: int, end_ns: int | None
    ) -> Iterator[Recorded]:
        if self._index.summary.chunk_indexes:
            self._file.seek(0)
            reader = _IndexedReader(self._file, self._index.summary)
            for _, channel, message in reader.iter_messages(
                topics, starting_at=start_ns, ending_before=end_ns
            ):
                yield Recorded(channel.topic, message.log_time, message.data)

    def _outside_chunks(
        self, topics: Collection[str], start_ns: int, end_ns: int | None
    ) -> Iterator[Recorded]:
        bare, channels = self._index.bare, self._index.summary.channels
        for at in bare.in_time_order():
            topic, time_ns = channels[bare.channels[at]].topic, bare.times[at]
            if topic in topics and start_ns <= time_ns and (end_ns is None or time_ns < end_ns):
                yield Recorded(topic, time_ns, bare.read(self._file, at).data)

    def busy_times(self, min_gap_ns: int) -> BusyTimes:
        """Return intervals (ns) with messages that have no gap of this length."""
        with self._reported_damage():
            return busy_times(self._file, self._index, min_gap_ns)

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    @contextmanager
    def _reported_damage(self) -> Iterator[None]:
        try:
            yield
        except ManycoreError:
            raise
        except Exception as error:  # the library and its decoders do not document their errors
            raise ManycoreError(
                f"{self.path}: is damaged: {type(error).__name__}: {what_is_wrong(error)}",
                EXIT_BAD_INPUT,
            ) from error


def _definition(schema: Schema) -> Definition:
    # Definitions of other encodings may be binary.
    return Definition(schema.encoding, schema.data.decode(errors="replace"))


class _IndexedReader(SeekingReader):
    """Reader with an explicit index, ignoring the file's."""

    def __init__(self, file: IO[bytes], summary: Summary) -> None:
        super().__init__(file, validate_crcs=True)
        self._given = summary

    def get_summary(self) -> Summary:
        return self._given
