# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Empty responses are those that rclpy would serialize."""

from __future__ import annotations

from typing import Any

import pytest
from rclpy.serialization import deserialize_message

from rmw_manycore_bridge.empty_answer import empty_answer
from rmw_manycore_bridge.outside import types
from rmw_manycore_py.ros.ament import interfaces, packages_with_interfaces

pytestmark = pytest.mark.unit

WITH_TEXTS = ("test_msgs/srv/Arrays",)  # arrays with default values
SERVICES = [
    name
    for package in packages_with_interfaces()
    for name in sorted(interfaces(package))
    if name.split("/")[1] == "srv" and types.hash_of(name) and name not in WITH_TEXTS
]
GOAL, RESULT = (f"test_msgs/action/Fibonacci_{part}" for part in ("SendGoal", "GetResult"))


def answered(service: str, reason: str = "") -> tuple[Any, Any]:
    """Return the response as a caller reads it, and its class."""
    kind = types.load(service).Response
    return deserialize_message(empty_answer(service, reason), kind), kind


def test_all_installed_services_and_actions() -> None:
    assert len(SERVICES) > 20
    for service in (*SERVICES, GOAL, RESULT):
        answer, kind = answered(service)
        if hasattr(answer, "return_code") and hasattr(answer, "goals_canceling"):
            answer.return_code = 0
        assert repr(answer) == repr(kind()), service


@pytest.mark.parametrize(
    ("service", "field"),
    [("std_srvs/srv/SetBool", "message"), ("nav_msgs/srv/LoadMap", None)],
)
def test_the_reason_is_in_a_suitable_field(service: str, field: str | None) -> None:
    answer, kind = answered(service, "the server is gone")
    if field is None:
        assert answer == kind()
    else:
        assert getattr(answer, field) == "the server is gone"


def test_goals_are_not_cancelled() -> None:
    kind = types.load("action_msgs/srv/CancelGoal").Response
    answer, _ = answered("action_msgs/srv/CancelGoal")
    assert answer.return_code == kind.ERROR_REJECTED


def test_a_type_without_a_description_is_refused() -> None:
    with pytest.raises(ValueError, match="unknown_msgs/srv/Do is installed without a description"):
        empty_answer("unknown_msgs/srv/Do", "")
