# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the model of a platform answers the timekeeper of a run in virtual time."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

from rmw_manycore_py.mapfile import load_mapfile, resolve
from rmw_manycore_py.prediction import TARGETS
from rmw_manycore_py.prediction.live import Answers, Live
from support.samples.profiles import MS, callback, pipeline, steady

pytestmark = pytest.mark.unit

DISPATCH_NS = 20_000  # from the timer that is due to its callback
TARGET = TARGETS["host"].changed({"switch_us": 0.0}, "chosen")


@pytest.fixture
def live(tmp_path: Path) -> Live:
    mapfile = tmp_path / "map.yaml"
    rows = [
        f"  {name}: {{cluster: 1, command: [sleep]}}\n" for name in ("camera", "filter", "sink")
    ]
    mapfile.write_text("nodes:\n" + "".join(rows))
    timer = callback(0, 2, kind="timer", period_ns=100 * MS, dispatch_ns=steady(DISPATCH_NS))
    profile = pipeline(callbacks=(timer, *pipeline().callbacks[1:]))
    return Live(resolve(load_mapfile(mapfile), to_start=False), profile, TARGET, 0)


def answers(live: Live, *requests: str) -> list[str]:
    """Return the answers to lines of the timekeeper."""
    said = io.StringIO()
    Answers(live, io.StringIO("\n".join(requests)), said).serve()
    return said.getvalue().splitlines()


def test_time_stops_before_what_is_done_at_that_instant(live: Live) -> None:
    """The timekeeper fires timers that are due then, before the thread goes on."""
    asked = f"ask 0 7 timer {100 * MS} /camera timer camera"
    assert answers(
        live, asked, f"advance {DISPATCH_NS}", f"advance {DISPATCH_NS + 1}", "resume"
    ) == [f"none {DISPATCH_NS}", f"done {DISPATCH_NS} 0 7"]


def test_time_passes_without_threads(live: Live) -> None:
    assert answers(live, f"advance {MS}", f"advance {MS}", f"advance {2 * MS}") == [
        f"none {MS}",
        f"none {MS}",
        f"none {2 * MS}",
    ]
