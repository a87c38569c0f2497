# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Scan matching in a trace: alignments of threads, and the work of their workers."""

from __future__ import annotations

from collections import defaultdict
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.trace.events import Events, Kind, ThreadId, Trace


class Matching(NamedTuple):
    """Scan matching within a span of a thread's time."""

    alignment_ns: int
    workers_ns: int  # part of it in which at least one worker was busy


class Matchings:
    """All alignments of a trace."""

    def __init__(self, trace: Trace) -> None:
        self._alignments: dict[ThreadId, _Spans] = {}
        passes: dict[tuple[int, int], list[Events]] = defaultdict(list)
        for thread, events in trace.threads_by_id().items():
            aligned = events[events["kind"] == Kind.ALIGN]
            if len(aligned):
                self._alignments[thread] = _Spans(aligned)
            passes[thread[:2]].append(events[events["kind"] == Kind.PASS])
        self._passes = {key: _Spans(np.concatenate(parts)) for key, parts in passes.items()}

    def between(self, thread: ThreadId, begin_ns: int, end_ns: int) -> Matching | None:
        """Return a thread's scan matching in a time span; None if there was none."""
        alignments = self._alignments.get(thread)
        aligned_ns = alignments.within(begin_ns, end_ns) if alignments else 0
        if not aligned_ns:
            return None
        return Matching(aligned_ns, self._passes[thread[:2]].within(begin_ns, end_ns))


class _Spans:
    """Time spans, with overlapping ones merged."""

    def __init__(self, events: Events) -> None:
        order = np.argsort(events["number"], kind="stable")
        begins = events["number"][order].astype(np.int64)
        ends = np.maximum.accumulate(events["value"][order].astype(np.int64))
        is_first = np.append(True, begins[1:] > ends[:-1])[: len(begins)]
        self._begins: NDArray[np.int64] = begins[is_first]
        self._ends: NDArray[np.int64] = ends[np.append(is_first[1:], True)[: len(begins)]]

    def within(self, begin_ns: int, end_ns: int) -> int:
        """Return the total time of the spans within an interval."""
        first = int(np.searchsorted(self._ends, begin_ns))
        last = int(np.searchsorted(self._begins, end_ns))
        begins = np.maximum(self._begins[first:last], begin_ns)
        return int(np.sum(np.minimum(self._ends[first:last], end_ns) - begins))
