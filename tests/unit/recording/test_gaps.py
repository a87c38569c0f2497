# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Long gaps between messages, and the notices of them before playing."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.cli.topic.gap_notices import gap_notices
from rmw_manycore_py.recording.recording import Recording
from support.samples.recordings import NS_PER_S, START_NS, write_texts

pytestmark = [pytest.mark.unit, pytest.mark.needs("mcap")]

YEAR_S = 365.25 * 86400
HOUR_S = 3600.0


@pytest.mark.parametrize("each", [0, 1, 2])
def test_each_long_gap_is_reported_with_options_that_skip_it(tmp_path: Path, each: int) -> None:
    times_s = [0.0, 12.5, 12.5 + HOUR_S - 1, 20_000.5, 2 * YEAR_S, 2 * YEAR_S + 1]
    texts = [("/a", time_s, "text") for time_s in times_s]
    with Recording(write_texts(tmp_path / "a.mcap", texts, each=each)) as recording:
        span = recording.span
        notices = list(gap_notices(recording, span.start_ns, span.end_ns))
        assert [notice.partition(": ")[2] for notice in notices] == [
            "no message for 4.6 hours after 3611.500 s: playing waits as long; --duration 3611.500 "
            "ends before it, --start-offset 20000.500 begins after it",
            "no message for 2.0 years after 20000.500 s: playing waits as long; --duration "
            "20000.500 ends before it, --start-offset 63115200.000 begins after it",
        ]
        at_ns = START_NS + 20_001 * NS_PER_S
        assert list(gap_notices(recording, at_ns, span.end_ns)) == []
        assert list(gap_notices(recording, START_NS, at_ns)) == notices[:1]


def test_more_than_three_are_counted(tmp_path: Path) -> None:
    texts = [("/a", 2 * HOUR_S * number, "text") for number in range(6)]
    with Recording(write_texts(tmp_path / "a.mcap", texts)) as recording:
        notices = list(gap_notices(recording, recording.span.start_ns, recording.span.end_ns))
        assert len(notices) == 4
        assert notices[-1].endswith("2 more such gaps")
