# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads one MCAP file."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, NamedTuple

import yaml
from mcap.reader import SeekingReader
from mcap.records import Channel, Message, Metadata, Statistics
from mcap.stream_reader import StreamReader
from mcap.summary import Summary
from mcap.writer import MCAP0_MAGIC

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError, what_is_wrong
from rmw_manycore_py.recording.definitions import Schema as Definition
from rmw_manycore_py.recording.metadata import Span, TopicRow
from rmw_manycore_py.recording.offers import offers_in
from rmw_manycore_py.recording.scan import Scanned, scan


class Recorded(NamedTuple):
    """A recorded message; times in ns since 1970."""

    topic: str
    recorded_ns: int
    data: bytes


class Input:
    """Reads a file by its index, or by one created by scanning."""

    def __init__(self, path: Path) -> None:
        """Open a file.

        :raises ManycoreError: if it cannot be read, or is no MCAP file.
        """
        self.path = path
        try:
            self._file: IO[bytes] = path.open("rb")
            self.size_bytes = path.stat().st_size
        except OSError as error:
            raise ManycoreError(
                f"{path}: cannot be read: {error.strerror}", EXIT_BAD_INPUT
            ) from error
        try:
            self._check_magic()
            self._index = self._own_index() or scan(self._file, self.size_bytes)
        except BaseException:
            self._file.close()
            raise

    def _check_magic(self) -> None:
        found = self._file.read(len(MCAP0_MAGIC))
        if found != MCAP0_MAGIC:
            what = "an empty file" if not found else f"{found!r}"
            raise ManycoreError(
                f"{self.path}: expected an MCAP file, which begins with {MCAP0_MAGIC!r}, found "
                f"{what}",
                EXIT_BAD_INPUT,
            )

    def _own_index(self) -> Scanned | None:
        """Return the file's index; None if it is missing or the file is unfinished."""
        try:
            summary = SeekingReader(self._rewound()).get_summary()
        except Exception:  # the end of a truncated file may be misread as an index
            return None
        if summary is None or summary.statistics is None:
            return None
        if summary.statistics.message_count and not (summary.channels and summary.chunk_indexes):
            return None
        return Scanned(summary, self.size_bytes, "")

    def _rewound(self) -> IO[bytes]:
        self._file.seek(0)
        return self._file

    @property
    def fault(self) -> str:
        """Return why the file ends early; "" if it does not."""
        return self._index.fault

    @property
    def span(self) -> Span:
        """Return the number of messages, and the first and last time."""
        found = self._statistics
        return Span(found.message_count, found.message_start_time, found.message_end_time)

    @property
    def _statistics(self) -> Statistics:
        assert self._index.summary.statistics is not None
        return self._index.summary.statistics

    def rows(self) -> list[TopicRow]:
        """Return the topics in channel order; a topic may have several channels.

        :raises ManycoreError: if the file is inconsistent.
        """
        with self._damage_told():
            return [self._row(channel) for channel in self._index.summary.channels.values()]

    def _row(self, channel: Channel) -> TopicRow:
        schema = self._index.summary.schemas.get(channel.schema_id)
        return TopicRow(
            name=channel.topic,
            type=schema.name if schema else "",
            type_hash=channel.metadata.get("topic_type_hash", ""),
            schema=Definition(schema.encoding, schema.data.decode()) if schema else Definition(),
            offers=offers_in(channel.metadata.get("offered_qos_profiles", "")),
            encoding=channel.message_encoding,
            messages=self._statistics.channel_message_counts.get(channel.id, 0),
        )

    def distro(self) -> str:
        """Return the ROS distribution stored by rosbag2; "" if there is none."""
        try:
            for found in SeekingReader(self._rewound()).iter_metadata():
                if isinstance(found, Metadata) and found.name == "rosbag2":
                    noted = yaml.safe_load(found.metadata.get("serialized_metadata", "")) or {}
                    return str(noted.get("ros_distro") or found.metadata.get("ROS_DISTRO", ""))
        except Exception:  # informational only
            return ""
        return ""

    def messages(
        self, topics: Collection[str], start_ns: int = 0, end_ns: int | None = None
    ) -> Iterator[Recorded]:
        """Yield the messages of topics in time order.

        Messages of files without chunks are in file order.

        :raises ManycoreError: where the file is damaged.
        """
        with self._damage_told():
            if self._index.summary.chunk_indexes:
                reader = _IndexedReader(self._rewound(), self._index.summary)
                for _, channel, message in reader.iter_messages(
                    topics, starting_at=start_ns, ending_before=end_ns
                ):
                    yield Recorded(channel.topic, message.log_time, message.data)
            elif self.span.messages:
                yield from self._in_file_order(topics, start_ns, end_ns)

    def _in_file_order(
        self, topics: Collection[str], start_ns: int, end_ns: int | None
    ) -> Iterator[Recorded]:
        channels = self._index.summary.channels
        file = self._rewound()
        for record in StreamReader(file, record_size_limit=self.size_bytes).records:
            if isinstance(record, Message):
                topic = channels[record.channel_id].topic
                is_in_time = record.log_time >= start_ns and (
                    end_ns is None or record.log_time < end_ns
                )
                if topic in topics and is_in_time:
                    yield Recorded(topic, record.log_time, record.data)
            if file.tell() >= self._index.end:
                return

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    @contextmanager
    def _damage_told(self) -> Iterator[None]:
        try:
            yield
        except ManycoreError:
            raise
        except Exception as error:  # the library and its decoders do not document their errors
            raise ManycoreError(
                f"{self.path}: is damaged: {type(error).__name__}: {what_is_wrong(error)}",
                EXIT_BAD_INPUT,
            ) from error


class _IndexedReader(SeekingReader):
    """Reader with an explicit index, ignoring the file's."""

    def __init__(self, file: IO[bytes], summary: Summary) -> None:
        super().__init__(file, validate_crcs=True)
        self._given = summary

    def get_summary(self) -> Summary:
        return self._given
