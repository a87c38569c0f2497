# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Recording session, from start to Ctrl-C, with its status output."""

from __future__ import annotations

import json
import math
import selectors
import time
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from typing import Any

from rmw_manycore_py.cli.common.printing import counted, echo, size_text
from rmw_manycore_py.cli.common.streams import leave_hung_up_terminal
from rmw_manycore_py.cli.topic.alarm import Alarm
from rmw_manycore_py.cli.topic.status_line import StatusLine
from rmw_manycore_py.process.signals import signal_inbox
from rmw_manycore_py.process.waits import wait_until_s
from rmw_manycore_py.recording.output import Output
from rmw_manycore_py.recording.record.recorder import Recorder
from rmw_manycore_py.recording.record.side import Side
from rmw_manycore_py.recording.record.writing import WritingThread
from rmw_manycore_py.recording.selection import Selection
from rmw_manycore_py.recording.target import Target


@dataclass(frozen=True)
class Settings:
    """What to record, and how."""

    selection: Selection
    target: Target
    force: bool
    duration_s: float | None
    compression: str
    cache_bytes: int
    depth: int


def record(platform: str | None, settings: Settings, *, as_json: bool) -> None:
    """Record a platform, or DDS if it is None, until stopped."""
    line = StatusLine(quiet=as_json)
    began_s = time.monotonic()
    with signal_inbox() as inbox, closing(_side(platform)) as side, closing(Alarm()) as ended:
        settings.target.prepare(force=settings.force)
        output = Output(settings.target.file, settings.compression)
        writing = WritingThread(output, settings.cache_bytes, ended.ring)
        recorder = Recorder(side, settings.selection, writing, settings.depth, line.print_line)
        line.print_line(f"writing {settings.target.file}; Ctrl-C stops")
        try:
            recorder.start(ended.ring)
            with selectors.DefaultSelector() as selector:
                selector.register(inbox, selectors.EVENT_READ)
                selector.register(ended, selectors.EVENT_READ)
                _wait(
                    selector,
                    settings.duration_s,
                    line,
                    lambda: _progress(recorder, output, began_s),
                )
        finally:
            recorder.stop()
            line.clear()
            found = writing.finish(recorder.rows)
    if recorder.failure is not None:
        raise recorder.failure
    settings.target.describe(found)
    leave_hung_up_terminal()  # the recording is whole all the same
    _report(settings.target, output, recorder, time.monotonic() - began_s, as_json)


def _side(platform: str | None) -> Side:
    if platform is None:
        from rmw_manycore_py.recording.record.outside import Outside

        return Outside()
    from rmw_manycore_py.recording.record.inside import Inside

    return Inside(platform)


def _wait(
    selector: selectors.BaseSelector,
    duration_s: float | None,
    line: StatusLine,
    progress: Callable[[], str],
) -> None:
    """Show progress until a signal, the end of the duration, or the end of the recorder."""
    end_s = math.inf if duration_s is None else time.monotonic() + duration_s
    while not selector.select(_pause_s(line, end_s)):
        if time.monotonic() >= end_s:
            return
        line.show(progress())


def _pause_s(line: StatusLine, end_s: float) -> float | None:
    pauses = (line.period_s, wait_until_s(end_s))
    return min((pause_s for pause_s in pauses if pause_s is not None), default=None)


def _progress(recorder: Recorder, output: Output, began_s: float) -> str:
    rows = recorder.rows
    parts = [
        f"recording {time.monotonic() - began_s:.1f} s",
        counted(len(rows), "topic"),
        counted(sum(row.messages for row in rows), "message"),
        size_text(output.size_bytes),
    ]
    if lost := sum(recorder.losses.values()):
        parts.append(f"{lost} lost")
    return " | ".join(parts)


def _report(
    target: Target, output: Output, recorder: Recorder, spent_s: float, as_json: bool
) -> None:
    if as_json:
        echo(json.dumps(_facts(target, output, recorder, spent_s)))
        return
    for topic, count in sorted(recorder.losses.items()):
        echo(f"lost: {counted(count, 'message')} of {topic}", err=True)
    echo(
        f"{target.path}: {counted(output.messages, 'message')} of "
        f"{counted(len(recorder.rows), 'topic')}, {size_text(output.size_bytes)} in {spent_s:.1f} s"
    )


def _facts(target: Target, output: Output, recorder: Recorder, spent_s: float) -> dict[str, Any]:
    return {
        "path": str(target.path),
        "file": str(target.file),
        "messages": output.messages,
        "size": output.size_bytes,
        "duration_s": spent_s,
        "topics": [
            {
                "name": row.name,
                "type": row.type,
                "messages": row.messages,
                "lost": recorder.losses.get(row.name, 0),
            }
            for row in recorder.rows
        ],
    }
