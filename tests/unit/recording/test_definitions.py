# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Definitions in the form that other readers need."""

from __future__ import annotations

import pytest
from rosbags.typesys import get_types_from_msg

from rmw_manycore_py.recording.definitions import NO_SCHEMA, schema_of

pytestmark = [pytest.mark.unit, pytest.mark.needs("rosbags")]


def test_all_nested_types_follow_the_root_once() -> None:
    schema = schema_of("geometry_msgs/msg/PoseWithCovarianceStamped")
    assert schema.encoding == "ros2msg"
    heads = [line for line in schema.text.splitlines() if line.startswith("MSG: ")]
    assert sorted(heads) == [
        "MSG: builtin_interfaces/Time",
        "MSG: geometry_msgs/Point",
        "MSG: geometry_msgs/Pose",
        "MSG: geometry_msgs/PoseWithCovariance",
        "MSG: geometry_msgs/Quaternion",
        "MSG: std_msgs/Header",
    ]
    parsed = get_types_from_msg(schema.text, "geometry_msgs/msg/PoseWithCovarianceStamped")
    assert set(parsed) == {
        "geometry_msgs/msg/PoseWithCovarianceStamped",
        *(f"{head[5:].replace('/', '/msg/')}" for head in heads),
    }


@pytest.mark.parametrize(
    "name", ["nix_msgs/msg/Nix", "std_msgs/msg/Nix", "test_msgs/action/Fibonacci_FeedbackMessage"]
)
def test_what_has_no_definition_here_has_none_in_the_recording(name: str) -> None:
    assert schema_of(name) == NO_SCHEMA
