# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The distribution in rosbag2's metadata."""

from __future__ import annotations

import pytest

from rmw_manycore_py.recording.metadata import own_metadata

pytestmark = pytest.mark.unit


def test_a_file_that_rosbag2_has_not_finished_has_the_distribution_only() -> None:
    assert own_metadata({"rosbag2": {"ROS_DISTRO": "iron"}}) == {"ros_distro": "iron"}
