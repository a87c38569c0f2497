# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Waits end at their own moments while a message is under way on the platform."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.profile.files import save
from rmw_manycore_py.profile.model import Subscription
from support import IS_MANYCORE
from support.nodes import timed_waits
from support.samples.profiles import MS, callback, pipeline, publishes

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]


CROSSING_MS = 50  # and again as much, until a message is read


def model_of(tmp_path: Path, crossing_ms: float) -> tuple[str, ...]:
    """Return options of a profile of the nodes, and of a platform with a slow network."""
    profile, platform = tmp_path / "p.json", tmp_path / "target.yaml"
    image = [Subscription(node=node, topic="/image", queue_depth=10) for node in (1, 2)]
    callbacks = (
        callback(0, 0, kind="timer", period_ns=100 * MS, publishes=publishes(0, 0)),
        *(callback(1 + at, 0, trigger="/image", subscription=at) for at in (0, 1)),
    )
    save(pipeline(subscriptions=tuple(image), callbacks=callbacks), profile)
    chosen = {"speed": 1, "message_us": 1000 * crossing_ms}
    values = ", ".join(f"{name}: {{value: {v}, source: chosen}}" for name, v in chosen.items())
    platform.write_text(f"base: coolidge\nparameters: {{{values}}}\n")
    return "--profile", str(profile), "--platform", str(platform)


def test_a_callback_that_the_profile_lacks_takes_no_time(
    timed_mapfile, log_of, tmp_path: Path
) -> None:
    file = timed_mapfile(timed_waits, "camera", "filter", "sink")
    log = log_of(file, 0.14, *model_of(tmp_path, 2))
    assert log["filter"] == ["silence 0", "image 104", "triggered 110", "asked 120", "missed 130"]


def test_a_wait_ends_while_a_message_is_under_way(timed_mapfile, log_of, tmp_path: Path) -> None:
    file = timed_mapfile(timed_waits, "camera", "filter", "sink")
    file.write_text(file.read_text().replace("sink], cluster: 1", "sink], cluster: 2"))
    log = log_of(file, 0.24, *model_of(tmp_path, CROSSING_MS))
    before = ["silence 0", "triggered 110", "asked 120", "missed 130"]
    assert log["filter"] == [*before, "image 200"]
    assert log["sink"] == ["answered 120", "image 200"]


def test_a_run_may_end_while_a_message_is_read(timed_mapfile, log_of, tmp_path: Path) -> None:
    file = timed_mapfile(timed_waits, "camera", "filter", "sink")
    log = log_of(file, 0.18, *model_of(tmp_path, CROSSING_MS))
    assert log["filter"] == ["silence 0", "triggered 110", "asked 120", "missed 130"]
