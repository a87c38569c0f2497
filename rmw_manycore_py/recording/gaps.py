# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Long gaps between messages, for example where a clock was set or rolled over."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import IO, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt
from mcap.data_stream import ReadDataStream
from mcap.records import Chunk, ChunkIndex, Message
from mcap.stream_reader import breakup_chunk

from rmw_manycore_py.recording.index import Index, content_at

Times: TypeAlias = npt.NDArray[np.uint64]


class BusyTimes(NamedTuple):
    """First and last times of messages (ns), one of each per interval."""

    starts: Times
    ends: Times


class Gap(NamedTuple):
    """A time without messages (ns)."""

    start_ns: int
    end_ns: int


def busy_times(file: IO[bytes], index: Index, min_gap_ns: int) -> BusyTimes:
    """Return intervals with messages; reads only chunks that may have a gap of this length."""
    bare = np.frombuffer(index.bare.times, np.uint64)
    starts, ends = [bare], [bare]
    first_ns = index.statistics.message_start_time
    for chunk in index.summary.chunk_indexes:
        start_ns, end_ns = chunk.message_start_time, chunk.message_end_time
        if end_ns - start_ns >= min_gap_ns:
            times = _times_in(file, chunk)
            starts.append(times)
            ends.append(times)
        elif start_ns >= first_ns:  # else it has no messages
            starts.append(np.array([start_ns], np.uint64))
            ends.append(np.array([end_ns], np.uint64))
    return BusyTimes(np.concatenate(starts), np.concatenate(ends))


def _times_in(file: IO[bytes], chunk: ChunkIndex) -> Times:
    content = content_at(file, chunk.chunk_start_offset)
    records = breakup_chunk(Chunk.read(ReadDataStream(BytesIO(content))))
    return np.array([one.log_time for one in records if isinstance(one, Message)], np.uint64)


def gaps_between(busy: Sequence[BusyTimes], min_gap_ns: int) -> list[Gap]:
    """Return the gaps of at least this length, in time order."""
    starts = np.concatenate([one.starts for one in busy])
    ends = np.concatenate([one.ends for one in busy])
    order = np.argsort(starts, kind="stable")
    starts, ends = starts[order], np.maximum.accumulate(ends[order])
    found = np.flatnonzero(starts[1:] > ends[:-1])
    gaps = (Gap(int(ends[at]), int(starts[at + 1])) for at in found)
    return [gap for gap in gaps if gap.end_ns - gap.start_ns >= min_gap_ns]
