# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The messages of /clock."""

from __future__ import annotations

import pytest
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock

from rmw_manycore_py.recording.play.clock import clock_message

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(
    ("time_ns", "seconds", "rest"),
    [
        (1_700_000_000_123_456_789, 1_700_000_000, 123_456_789),
        (-1, -1, 999_999_999),
        (2**64 - 1, 2**31 - 1, 999_999_999),
    ],
)
def test_a_time_is_within_those_of_ros(time_ns: int, seconds: int, rest: int) -> None:
    clock = deserialize_message(clock_message(time_ns), Clock).clock
    assert (clock.sec, clock.nanosec) == (seconds, rest)
