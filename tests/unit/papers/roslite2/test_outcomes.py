# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The outcome of a fault, derived from the commands and warnings after it."""

from __future__ import annotations

import pytest

from rmw_manycore_py.papers.roslite2.laptop.drive_log import (
    Command,
    DriveLog,
    Incident,
    Injected,
    Moment,
)
from rmw_manycore_py.papers.roslite2.laptop.outcomes import outcomes

pytestmark = pytest.mark.unit


def commands(*speeds: tuple[float, float, float]) -> list[Command]:
    """Return commands each 20 ms, as (from, to, speed)."""
    return [
        Command(start + 0.02 * step, speed, 0.0)
        for start, end, speed in speeds
        for step in range(round((end - start) / 0.02))
    ]


def log_of(*speeds: tuple[float, float, float], texts: tuple[str, ...] = ()) -> DriveLog:
    log = DriveLog(10.0, commands=commands(*speeds))
    log.injected.append(Injected(1.01, "ekf_localizer", "kill -9: ekf_localizer"))
    log.incidents += [Incident(1.2, text) for text in texts]
    return log


def test_zero_commands():
    (outcome,) = outcomes(log_of((0, 1.3, 1.5), (1.3, 4, 0.0), (4, 6, 1.0)))
    assert outcome.stood_s == pytest.approx(0.29)
    assert outcome.drove_on_s == pytest.approx(2.99)


def test_no_commands():
    """Half a second after the last command the wheelchair stops by itself."""
    (outcome,) = outcomes(log_of((0, 1.02, 1.5), (3, 5, 1.0)))
    assert outcome.stood_s == pytest.approx(0.49)
    assert outcome.drove_on_s == pytest.approx(1.99)


def test_a_vehicle_that_drives_on():
    (outcome,) = outcomes(log_of((0, 8, 1.5)))
    assert (outcome.stood_s, outcome.drove_on_s) == (None, None)


def test_the_end_of_the_course_is_no_outcome():
    (outcome,) = outcomes(log_of((0, 5, 1.5), (5, 6, 0.0)))
    assert outcome.stood_s is None


@pytest.mark.parametrize(
    ("speeds", "stands"),
    [((1.0, 0.0, 1.0), 1), ((1.0, 0.0, 1.0, 0.0), 1), ((1.0, 0.0), 0), ((1.0, 1.0), 0)],
)
def test_where_a_finished_drive_ends_is_no_stand_on_the_way(speeds, stands):
    """The drive may end before another sample is recorded."""
    log = log_of((0, 4, 1.0))
    log.is_finished = True
    log.moments += [Moment(1.0 + i, 0.0, 0.0, speed, 0.0, 0.0) for i, speed in enumerate(speeds)]
    assert log.summary().stands == stands


def test_names():
    texts = (
        "vehicle_cmd_gate: /localization/kinematic_state: ekf_localizer is gone",
        "ekf_localizer: /sensing/imu: gyro_odometer is gone",
        "ekf_localizer killed by SIGKILL: it is started again",
    )
    (outcome,) = outcomes(log_of((0, 8, 1.5), texts=texts))
    assert outcome.named_by == texts[:1]
    assert outcome.was_restarted
