# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Traces started from the page."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.errors import translate_native_errors

if TYPE_CHECKING:
    from rmw_manycore_py.trace.events import Trace

# Per thread: half a minute at thousands of messages per second.
RING_EVENTS = 1 << 18


class Tracing:
    """Traces of one platform, stored in a directory until the viewer ends."""

    def __init__(self, platform: str, directory: Path) -> None:
        self._platform = platform
        self._directory = directory
        self._numbers = itertools.count(1)

    def start(self) -> None:
        """Start a trace of the whole platform."""
        with translate_native_errors():
            _transport.start_trace(
                self._platform, clusters=[], nodes=[], events=RING_EVENTS, discard=False
            )

    def stop(self) -> dict[str, Any]:
        """Stop the trace if it is on, save it, and analyse its chains."""
        # Loaded when needed: the formats of trace files would delay the first picture.
        from rmw_manycore_py.trace.files.saving import save_recorded

        with translate_native_errors():
            if _transport.trace_state(self._platform).started_ns:
                _transport.stop_trace(self._platform)
        path = self._directory / f"{self._platform}-{next(self._numbers)}.json"
        trace = save_recorded(self._platform, path)
        return {
            "file": path.name,
            "bytes": path.stat().st_size,
            "events": trace.event_count,
            "lost": trace.lost,
            "chains": chain_rows(trace),
        }

    def file(self, name: str) -> Path | None:
        """Return the path of a saved trace; None for an unknown name."""
        path = self._directory / name
        return path if path.parent == self._directory and path.is_file() else None


def chain_rows(trace: Trace) -> list[dict[str, Any]]:
    """Return the latency of all chains."""
    # Loaded when needed: it would delay the first picture.
    from rmw_manycore_py.trace.chains import Messages
    from rmw_manycore_py.trace.latency import latencies

    messages = Messages(trace)
    return [one.row() for one in latencies(messages, messages.chains)]
