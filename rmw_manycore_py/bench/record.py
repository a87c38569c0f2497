# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Losses of the recorder and timing of the player; no peer, since rosbag2 is not on PyPI."""

from __future__ import annotations

import os
import signal
import tempfile
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py.bench.contenders import INSIDE, MIB
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.errors.missing_library import MCAP, require

TOPIC = "/bench"
SECONDS = 20.0
_CLI = "rmw_manycore_py.cli"
_UNCOUNTED = "lost messages that the recorder did not count"
_LOST, _LATE, _RATE = "messages lost by the recorder", "lateness of the player", "recorded"
_MEDIAN, _P99 = "median", "p99"


@dataclass(frozen=True)
class Stream:
    """Messages of one size at one rate."""

    name: str
    size_bytes: int
    rate_hz: int


LARGE = Stream("1 MiB at 100 Hz", MIB, 100)
MIDDLE = Stream("64 KiB at 1600 Hz", MIB // 16, 1600)
SMALL = Stream("100 B at 1000 Hz", 100, 1000)
STREAMS = (LARGE, MIDDLE, SMALL)


def measure(run: Run) -> list[Result]:
    """Record each stream, and play the recording."""
    require(MCAP)
    return [
        result for stream in STREAMS if run.wants(stream.name) for result in _measure(run, stream)
    ]


def _measure(run: Run, stream: Stream) -> list[Result]:
    from rmw_manycore_py.recording.recording import Recording  # imported late: loads the library

    lost, uncounted, rates, medians, p99s = [], [], [], [], []
    for turn in range(run.rounds):
        with tempfile.TemporaryDirectory() as directory:
            file = Path(directory, "bench.mcap")
            run.note(f"record, round {turn + 1} of {run.rounds}: {stream.name}")
            sent, bytes_per_s, counted = _record(run, stream, file)
            with Recording(file) as recording:
                lost.append(float(sent - recording.span.messages))
            uncounted.append(abs(lost[-1] - counted))
            rates.append(bytes_per_s / 1e6)
            run.note(f"play, round {turn + 1} of {run.rounds}: {stream.name}")
            median_ms, p99_ms = _play(run, file)
            medians.append(median_ms)
            p99s.append(p99_ms)
    return [
        Result(_LOST, stream.name, "count", tuple(lost)),
        Result(_UNCOUNTED, stream.name, "count", tuple(uncounted)),
        Result(_RATE, stream.name, "MB/s", tuple(rates), higher_is_better=True),
        Result(_LATE, f"{stream.name}, {_MEDIAN}", "ms", tuple(medians)),
        Result(_LATE, f"{stream.name}, {_P99}", "ms", tuple(p99s)),
    ]


def _record(run: Run, stream: Stream, file: Path) -> tuple[int, float, int]:
    """Return the number of published messages, bytes per second, and reported losses."""
    count = run.iterations(int(SECONDS * stream.rate_hz))
    with Session(INSIDE, run.cpus) as session:
        recorder = session.module(_CLI, 1, "topic", "record", TOPIC, "-o", file, "--json")
        source = session.python("steady", 0, TOPIC, stream.size_bytes, stream.rate_hz, count)
        found = source.finish()
        os.kill(recorder.pid, signal.SIGINT)
        (topic,) = recorder.finish()["topics"]
    return int(found["sent"]), float(found["bytes_per_s"]), int(topic["lost"])


def _play(run: Run, file: Path) -> tuple[float, float]:
    """Return the lateness of published messages in ms: median and 99th percentile."""
    with Session(INSIDE, run.cpus) as session:
        found = session.module(_CLI, 0, "topic", "play", file, "--json").finish()
    return float(found["late_ms_p50"]), float(found["late_ms_p99"])


QUESTION = Question(
    "record",
    measure,
    (
        *(Goal(_LOST, stream.name, "within", 0, statistic="largest") for stream in STREAMS),
        *(Goal(_UNCOUNTED, stream.name, "within", 0, statistic="largest") for stream in STREAMS),
        *(Goal(_LATE, f"{stream.name}, {_MEDIAN}", "within", 0.5) for stream in STREAMS),
    ),
    "publisher and player on the first CPU, recorder on the second, files in $TMPDIR",
)
