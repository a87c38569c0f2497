# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parts of messages, and filters."""

from __future__ import annotations

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped

from rmw_manycore_py.cli.topic.message_part import message_filter, part_of
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

pytestmark = pytest.mark.unit


def test_a_path_leads_to_fields_and_elements() -> None:
    message = DiagnosticArray(status=[DiagnosticStatus(name="a"), DiagnosticStatus(name="b")])
    assert part_of(message, "status[1].name") == "b"
    assert part_of(message, "header.stamp.sec") == 0
    assert part_of(message, "") is message


@pytest.mark.parametrize(
    ("path", "error"),
    [
        ("pose.nowhere", "Invalid field 'nowhere': there is position, orientation"),
        ("pose.position.x.y", "Invalid field 'y': there is none"),
        ("pose.position[0]", r"no element 'position\[0\]'"),
        ("pose/position", "expected a path"),
    ],
)
def test_a_path_to_nothing_is_refused(path: str, error: str) -> None:
    with pytest.raises(ManycoreError, match=error) as caught:
        part_of(PoseStamped(), path)
    assert caught.value.exit_status == EXIT_BAD_INPUT


def test_a_filter_reads_the_message() -> None:
    assert message_filter(None)(PoseStamped())
    assert not message_filter("m.pose.position.x > 1")(PoseStamped())
    assert message_filter("m.pose.orientation.w == 1")(PoseStamped())


@pytest.mark.parametrize("expression", ["m.", "m.nowhere", "import os"])
def test_a_filter_that_is_wrong_is_refused(expression: str) -> None:
    with pytest.raises(ManycoreError, match="the filter"):
        message_filter(expression)(PoseStamped())
