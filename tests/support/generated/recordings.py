# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""MCAP files made at random, in the variety that other programs write."""

from __future__ import annotations

import io
import random
import struct

from mcap.opcode import Opcode
from mcap.reader import FOOTER_SIZE
from mcap.writer import MCAP0_MAGIC, CompressionType, IndexType, Writer

from support.generated import mutation

NS_PER_S = 1_000_000_000
LAST_NS = 2**64 - 1
_TYPES = ("std_msgs/msg/String", "geometry_msgs/msg/Pose", "foxglove.Log", "")
_PROFILES = (
    *("", "", "- history: 1\n  depth: 10\n", "3", "[{}]", "{", "2024-13-01", "- a\n", "null"),
    (
        "- {history: 3, depth: 0, reliability: 1, durability: 2, deadline: {sec: 0, nsec: 0}, "
        "lifespan: {sec: 0, nsec: 0}, liveliness: 1, "
        "liveliness_lease_duration: {sec: 0, nsec: 0}}\n"
    ),
)
_PRIVATE = 0x81  # first opcode of private records
_HEAD = struct.Struct("<BQ")
_END = FOOTER_SIZE + len(MCAP0_MAGIC)


def made(number: int) -> bytes:
    """Return the file of a number."""
    chance = random.Random(number)
    content = _written(chance)
    if chance.random() < 0.3:
        content = _with_more_records(chance, content)
    if chance.random() < 0.15:
        content = _without_summary(content)
    if chance.random() < 0.15:
        content = content[: chance.randrange(len(MCAP0_MAGIC), len(content))]
    return content


def damaged(number: int) -> bytes:
    """Return the file of a number, damaged."""
    patches = (b"\xff" * 8, b"\0" * 8, b"\0\0\0\1" * 2)
    return mutation.damaged(random.Random(number), made(number), patches)


def _written(chance: random.Random) -> bytes:
    file = io.BytesIO()
    writer = Writer(
        file,
        chunk_size=chance.choice((1, 100, 1000, 1 << 20)),
        compression=chance.choice(list(CompressionType)),
        index_types=_indexes(chance),
        repeat_channels=chance.random() < 0.8,
        repeat_schemas=chance.random() < 0.6,
        use_chunking=chance.random() < 0.75,
        use_statistics=chance.random() < 0.8,
        use_summary_offsets=chance.random() < 0.7,
        enable_crcs=chance.random() < 0.8,
        enable_data_crcs=chance.random() < 0.3,
    )
    writer.start(chance.choice(("ros2", "", "x")))
    channels = [_channel(chance, writer) for _ in range(chance.randint(1, 4))]
    at_ns = chance.choice((0, 1, 1_700_000_000 * NS_PER_S))
    for sequence in range(chance.choice((0, 1, 5, 40))):
        at_ns += chance.choice((0, 1, NS_PER_S // 10, NS_PER_S, -NS_PER_S))
        at_ns = chance.choice((0, LAST_NS)) if chance.random() < 0.02 else min(max(at_ns, 0), 2**62)
        data = chance.randbytes(chance.choice((1, 4, 60)))
        writer.add_message(chance.choice(channels), at_ns, data, at_ns, sequence)
        if chance.random() < 0.05:
            writer.flush()
        if chance.random() < 0.05:
            writer.add_metadata("rosbag2", {"serialized_metadata": chance.choice(_PROFILES)})
        if chance.random() < 0.05:
            writer.add_attachment(0, 0, "a.txt", "text/plain", b"\x05" * 30)
    if chance.random() < 0.05:  # allowed for writers that do not count
        writer._Writer__statistics.channel_message_counts.clear()
    writer.finish()
    return file.getvalue()


def _indexes(chance: random.Random) -> IndexType:
    if chance.random() < 0.6:
        return IndexType.ALL
    kinds = [IndexType.ATTACHMENT, IndexType.CHUNK, IndexType.MESSAGE, IndexType.METADATA]
    chosen = IndexType.NONE
    for kind in kinds:
        if chance.random() < 0.5:
            chosen |= kind
    return chosen


def _channel(chance: random.Random, writer: Writer) -> int:
    schema = 0
    if chance.random() < 0.85:
        text = chance.choice((b"string data", b"", b"\xff\xfe\0binary"))
        encoding = chance.choice(("ros2msg", "ros2idl", "protobuf", ""))
        schema = writer.register_schema(chance.choice(_TYPES), encoding, text)
    topic = chance.choice(("/a", "/b", "plain", "/with space"))
    metadata = {"offered_qos_profiles": chance.choice(_PROFILES)} if chance.random() < 0.7 else {}
    return writer.register_channel(topic, chance.choice(("cdr", "json", "")), schema, metadata)


def _with_more_records(chance: random.Random, content: bytes) -> bytes:
    """Insert records at the end of the data: private ones, or a message outside of chunks."""
    at = _end_of_data(content)
    more = b""
    channel = _last_channel(content[:at])
    for _ in range(chance.randint(1, 3)):
        if chance.random() < 0.5:
            body = chance.randbytes(chance.randrange(60))
            more += _HEAD.pack(chance.randrange(_PRIVATE, 256), len(body)) + body
        elif channel is not None:
            body = struct.pack("<HIQQ", channel, 0, chance.randrange(2**61), 0) + b"bare"
            more += _HEAD.pack(Opcode.MESSAGE, len(body)) + body
    return content[:at] + more + _moved(content[at:], len(more))


def _moved(tail: bytes, by: int) -> bytes:
    """Return end of data, summary and footer as they are after an insertion before them."""
    start, offsets, _ = struct.unpack_from("<QQI", tail, len(tail) - _END + _HEAD.size)
    footer = struct.pack("<QQI", start + by if start else 0, 0 if not offsets else offsets + by, 0)
    tail = tail[: len(tail) - _END] + _HEAD.pack(Opcode.FOOTER, len(footer)) + footer + MCAP0_MAGIC
    at = tail.index(_HEAD.pack(Opcode.DATA_END, 4))
    return tail[: at + _HEAD.size] + b"\0" * 4 + tail[at + _HEAD.size + 4 :]  # no CRC


def _without_summary(content: bytes) -> bytes:
    footer = _HEAD.pack(Opcode.FOOTER, 20) + b"\0" * 20
    end = _HEAD.pack(Opcode.DATA_END, 4) + b"\0" * 4
    return content[: _end_of_data(content)] + end + footer + MCAP0_MAGIC


def _end_of_data(content: bytes) -> int:
    return next(at for at, opcode, _ in _records(content) if opcode == Opcode.DATA_END)


def _last_channel(content: bytes) -> int | None:
    """Return the id of a channel whose record is outside of chunks."""
    found = None
    for at, opcode, _ in _records(content):
        if opcode == Opcode.CHANNEL:
            (found,) = struct.unpack_from("<H", content, at + _HEAD.size)
    return found


def _records(content: bytes):
    at = len(MCAP0_MAGIC)
    while at < len(content):
        opcode, length = _HEAD.unpack_from(content, at)
        yield at, opcode, length
        at += _HEAD.size + length
