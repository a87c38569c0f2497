# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Suggestions for names that do not exist."""

from __future__ import annotations

import pytest

from rmw_manycore_py.errors.suggestions import did_you_mean

pytestmark = pytest.mark.unit

TYPES = ["std_msgs/msg/Int8", "std_msgs/msg/String", "std_srvs/srv/SetBool"]


@pytest.mark.parametrize(
    ("name", "known", "meant"),
    [
        ("chattr", ["/chatter", "/rosout"], "/chatter"),
        ("/talker", ["/left/talker", "/listener"], "/left/talker"),
        ("std_msgs/String", TYPES, "std_msgs/msg/String"),
        ("std_msgs/msg/string", TYPES, "std_msgs/msg/String"),
        ("std_msgs/msg/Nope", TYPES, None),
        ("/chatter", [], None),
    ],
)
def test_the_closest_name_is_suggested(name: str, known: list[str], meant: str | None) -> None:
    assert did_you_mean(name, known) == (f"; did you mean '{meant}'?" if meant else "")
