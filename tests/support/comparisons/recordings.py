# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""MCAP files read by us and by the reader of `mcap` that reads them from their start."""

from __future__ import annotations

import io
import struct
from collections import Counter
from itertools import pairwise
from pathlib import Path
from typing import Any

from mcap.exceptions import McapError
from mcap.records import Channel, Footer, Message, Schema
from mcap.stream_reader import StreamReader

from rmw_manycore_py.cli.topic.gap_notices import MIN_GAP_NS, gap_notices
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.recording.recording import Recording
from support.comparisons.comparing import DisagreementError, run
from support.generated.recordings import damaged, made

Found = list[tuple[int, str, bytes]]  # time, topic, data


def ours(path: Path) -> tuple[Found, Counter[tuple[str, str]], list[int], bool]:
    """Return messages, their counts per topic and type, the ends of gaps; whether it is whole."""
    with Recording(path) as recording:
        topics = {row.name for row in recording.topics}
        found = [(m.recorded_ns, m.topic, m.data) for m in recording.messages(topics)]
        counts = Counter({(row.name, row.type): row.messages for row in recording.topics})
        gaps = [gap.end_ns for gap in recording.gaps(MIN_GAP_NS)]
        span = recording.span
        notices = list(gap_notices(recording, span.start_ns, span.end_ns))
        texts = [*notices, *recording.faults, *recording.remarks, recording.distro]
        if not all(text.isprintable() for text in texts):
            raise DisagreementError(f"unprintable: {texts}")
        if span.messages != len(found) or sum(counts.values()) != len(found):
            raise DisagreementError(f"{span.messages} messages, {counts}, read {len(found)}")
        if found and (span.start_ns, span.end_ns) != (found[0][0], found[-1][0]):
            raise DisagreementError(f"{span}, read from {found[0][0]} to {found[-1][0]}")
        return found, counts, gaps, not recording.faults


def mcaps(content: bytes) -> tuple[Found, Counter[tuple[str, str]], list[int], bool]:
    schemas: dict[int, Schema] = {}
    channels: dict[int, Channel] = {}
    found, counts = [], Counter[tuple[str, str]]()
    is_whole = False
    try:
        for record in StreamReader(io.BytesIO(content), record_size_limit=len(content)).records:
            if isinstance(record, Schema):
                schemas[record.id] = record
            elif isinstance(record, Channel):
                channels[record.id] = record
                counts[_key(record, schemas)] += 0
            elif isinstance(record, Message):
                channel = channels[record.channel_id]
                found.append((record.log_time, channel.topic, record.data))
                counts[_key(channel, schemas)] += 1
            is_whole = isinstance(record, Footer)
    except (McapError, ValueError, struct.error):
        is_whole = False
    times = sorted(time for time, _, _ in found)
    gaps = [b for a, b in pairwise(times) if b - a >= MIN_GAP_NS]
    return found, counts, gaps, is_whole


def _key(channel: Channel, schemas: dict[int, Any]) -> tuple[str, str]:
    schema = schemas.get(channel.schema_id)
    return channel.topic, schema.name if schema else ""


def compare(directory: Path, number: int) -> str:
    path = directory / "a.mcap"
    path.write_bytes(damaged(number))
    try:
        ours(path)
        end = "damage read"
    except ManycoreError as error:
        if not str(error).isprintable():
            raise DisagreementError(f"unprintable: {error}") from error
        end = "damage refused"
    except DisagreementError:  # counts that were damaged
        end = "damage misread"
    content = made(number)
    path.write_bytes(content)
    (found, counts, gaps, is_whole), (real, real_counts, real_gaps, is_real_whole) = (
        ours(path), mcaps(content),
    )  # fmt: skip
    if [time for time, _, _ in found] != sorted(time for time, _, _ in real):
        raise DisagreementError(f"{len(found)} messages, mcap reads {len(real)}: not their times")
    if sorted(found) != sorted(real) or counts != real_counts:
        raise DisagreementError(f"{found} {counts}, mcap reads {real} {real_counts}")
    if gaps != real_gaps or is_whole < is_real_whole:
        raise DisagreementError(f"gaps {gaps} {real_gaps}, whole {is_whole} {is_real_whole}")
    return f"{end}, {'whole' if is_whole else 'cut'}"


if __name__ == "__main__":
    run(compare)
