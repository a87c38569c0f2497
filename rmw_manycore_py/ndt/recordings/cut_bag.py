# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads bags whose end is missing, as after a power failure, up to there.

Without its end an MCAP file has no summary, a ROS 1 bag no index, and a SQLite file fewer pages
than its header counts; a folder has no metadata.yaml. `rosbags` refuses all of these.
"""

from __future__ import annotations

import bz2
import struct
from collections.abc import Callable, Collection, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from functools import lru_cache, partial
from io import BytesIO
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, NamedTuple

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.errors.missing_library import MCAP, require
from rmw_manycore_py.ndt.recordings.sqlite_rows import SqlitePages

if TYPE_CHECKING:
    from rmw_manycore_py.recording.recording import Recording

_MESSAGE = ("id", "topic_id", "timestamp", "data")
_COLUMNS_OF_TOPICS = (4, 5, 6)  # of all versions of rosbag2
_ROS1_BEGIN = b"#ROSBAG V2.0\n"
_ROS1_MESSAGE, _ROS1_CHUNK, _ROS1_CONNECTION = 2, 5, 7
_LENGTH = struct.Struct("<I")


class Connection(NamedTuple):
    """A topic, like a connection of rosbags."""

    topic: str
    msgtype: str


class _Stored(NamedTuple):
    """A message that can be read."""

    time_ns: int
    connection: Connection
    read: Callable[[], bytes]


@dataclass(frozen=True)
class CutBag:
    """A bag that was cut, with the interface of rosbags' reader."""

    stored: list[_Stored]
    typestore: Any
    is_ros1: bool
    closing: ExitStack

    @property
    def connections(self) -> list[Connection]:
        """Return the topics that have messages."""
        return list(dict.fromkeys(one.connection for one in self.stored))

    def messages(
        self, connections: Collection[Connection], start: int | None = None, stop: int | None = None
    ) -> Iterator[tuple[Connection, int, bytes]]:
        """Yield connection, time in ns and data of the messages in a time range."""
        for one in self.stored:
            is_late = start is None or one.time_ns >= start
            if one.connection in connections and is_late and (stop is None or one.time_ns < stop):
                yield one.connection, one.time_ns, one.read()

    def deserialize(self, data: bytes, msgtype: str) -> Any:
        """Return a message."""
        read = self.typestore.deserialize_ros1 if self.is_ros1 else self.typestore.deserialize_cdr
        return read(data, msgtype)

    def close(self) -> None:
        """Close its files."""
        self.closing.close()


def open_cut_bag(files: list[Path]) -> CutBag | None:
    """Open the remains of a bag; None if there is no message."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    is_ros1 = any(file.suffix == ".bag" for file in files)
    typestore = get_typestore(Stores.ROS1_NOETIC if is_ros1 else Stores.ROS2_JAZZY)
    if is_ros1:
        text = "geometry_msgs/TransformStamped[] transforms"
        typestore.register(get_types_from_msg(text, "tf2_msgs/msg/TFMessage"))
    with ExitStack() as closing:
        stored = [one for file in files for one in _READERS[file.suffix](file, closing)]
        stored.sort(key=lambda one: one.time_ns)
        return CutBag(stored, typestore, is_ros1, closing.pop_all()) if stored else None


def _sqlite(file: Path, closing: ExitStack) -> Iterator[_Stored]:
    """Yield the rows in a file of rosbag2: its tables `topics` and `messages`."""
    try:
        pages = SqlitePages(closing.enter_context(file.open("rb")))
    except (OSError, ValueError):
        return
    closing.callback(pages.close)
    topics: dict[object, Connection] = {}
    for columns in _COLUMNS_OF_TOPICS:
        for row in pages.rows(columns):
            name, kind = row.values[1:3]
            if isinstance(name, bytes) and isinstance(kind, bytes) and kind.count(b"/") == 2:
                topics.setdefault(row.number, Connection(name.decode(), kind.decode()))
    for row in pages.rows(len(_MESSAGE)):
        _, topic, time_ns, data = row.values
        if topic in topics and isinstance(time_ns, int) and isinstance(data, bytes):
            yield _Stored(time_ns, topics[topic], partial(_sqlite_data, pages, row.place))


def _sqlite_data(pages: SqlitePages, place: tuple[int, int]) -> bytes:
    data = pages.values(place)[_MESSAGE.index("data")]
    assert isinstance(data, bytes)
    return data


def _mcap(file: Path, closing: ExitStack) -> Iterator[_Stored]:
    require(MCAP)
    from rmw_manycore_py.recording.recording import Recording

    try:
        recording = closing.enter_context(Recording(file))
        topics = {row.name: Connection(row.name, row.type) for row in recording.topics}
        seen: dict[tuple[str, int], int] = {}
        for topic, time_ns, _ in recording.messages(topics):
            nth = seen[topic, time_ns] = seen.get((topic, time_ns), -1) + 1
            read = partial(_mcap_data, recording, topic, time_ns, nth)
            yield _Stored(time_ns, topics[topic], read)
    except ManycoreError:
        return


def _mcap_data(recording: Recording, topic: str, time_ns: int, nth: int) -> bytes:
    return list(recording.messages({topic}, time_ns, time_ns + 1))[nth].data


def _ros1(file: Path, closing: ExitStack) -> Iterator[_Stored]:
    content = closing.enter_context(file.open("rb"))
    if content.read(len(_ROS1_BEGIN)) != _ROS1_BEGIN:
        return
    chunk_at = lru_cache(maxsize=2)(partial(_ros1_chunk_at, content))
    connections: dict[int, Connection] = {}
    try:
        while True:
            at = content.tell()
            header, _ = _ros1_record(content)
            if header[b"op"][0] == _ROS1_CHUNK:
                after = content.tell()
                yield from _ros1_chunk(at, chunk_at, connections)
                content.seek(after)
    except (EOFError, LookupError, ValueError, OSError, RuntimeError, struct.error):
        return


def _ros1_chunk_at(file: IO[bytes], at: int) -> bytes:
    file.seek(at)
    return _unpacked(*_ros1_record(file))


def _ros1_chunk(
    at: int, chunk_at: Callable[[int], bytes], connections: dict[int, Connection]
) -> Iterator[_Stored]:
    records = BytesIO(chunk_at(at))
    size = len(records.getbuffer())
    while records.tell() < size:
        header, data = _ros1_record(records)
        operation = header[b"op"][0]
        number = int.from_bytes(header.get(b"conn", b""), "little")
        if operation == _ROS1_CONNECTION:
            kind = _ros1_fields(data)[b"type"].decode().replace("/", "/msg/")
            connections[number] = Connection(header[b"topic"].decode(), kind)
        elif operation == _ROS1_MESSAGE:
            seconds, nanoseconds = struct.unpack("<II", header[b"time"])
            place = slice(records.tell() - len(data), records.tell())
            read = partial(_ros1_data, chunk_at, at, place)
            yield _Stored(seconds * 10**9 + nanoseconds, connections[number], read)


def _ros1_data(chunk_at: Callable[[int], bytes], at: int, place: slice) -> bytes:
    return chunk_at(at)[place]


def _unpacked(header: dict[bytes, bytes], data: bytes) -> bytes:
    compression = header.get(b"compression", b"none")
    if compression == b"bz2":
        return bz2.decompress(data)
    if compression == b"lz4":
        import lz4.frame

        return bytes(lz4.frame.decompress(data))
    return data


def _ros1_record(file: IO[bytes]) -> tuple[dict[bytes, bytes], bytes]:
    return _ros1_fields(_ros1_bytes(file)), _ros1_bytes(file)


def _ros1_bytes(file: IO[bytes]) -> bytes:
    head = file.read(_LENGTH.size)
    size = _LENGTH.unpack(head)[0] if len(head) == _LENGTH.size else 0
    found = file.read(size)
    if len(head) < _LENGTH.size or len(found) < size:
        raise EOFError
    return found


def _ros1_fields(data: bytes) -> dict[bytes, bytes]:
    fields, at = {}, 0
    while at < len(data):
        (size,) = _LENGTH.unpack_from(data, at)
        name, _, value = data[at + _LENGTH.size : at + _LENGTH.size + size].partition(b"=")
        fields[name] = value
        at += _LENGTH.size + size
    return fields


_READERS: dict[str, Callable[[Path, ExitStack], Iterator[_Stored]]] = {
    ".db3": _sqlite,
    ".mcap": _mcap,
    ".bag": _ros1,
}
