# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Selection of topics."""

from __future__ import annotations

import re

import pytest

from rmw_manycore_py.recording.selection import Selection

pytestmark = pytest.mark.unit

TOPICS = ("/chatter", "/camera/image", "/camera/left/image", "/rosout", "/_hidden", "/a/_b")
IMAGE = "sensor_msgs/msg/Image"


def chosen(selection: Selection) -> set[str]:
    return {t for t in TOPICS if selection.takes(t, IMAGE if "image" in t else "std_msgs/msg/X")}


@pytest.mark.parametrize(
    ("selection", "expected"),
    [
        (Selection(names=("/chatter", "/nix")), {"/chatter"}),
        (Selection(names=("/_hidden",)), {"/_hidden"}),
        (Selection(names=("/camera/*",)), {"/camera/image"}),
        (Selection(names=("/camera/**",)), {"/camera/image", "/camera/left/image"}),
        (Selection(all=True), {"/chatter", "/camera/image", "/camera/left/image", "/rosout"}),
        (Selection(all=True, hidden=True), set(TOPICS)),
        (Selection(regex=re.compile("^/c.*e$")), {"/camera/image", "/camera/left/image"}),
        (Selection(types=(IMAGE,)), {"/camera/image", "/camera/left/image"}),
        (Selection(all=True, excluded=("/camera/**", "/rosout")), {"/chatter"}),
        (
            Selection(all=True, exclude_regex=re.compile("left|ros")),
            {"/chatter", "/camera/image"},
        ),
        (Selection(names=("/chatter",), excluded=("/chatter",)), set()),
        (Selection(), set()),
    ],
)
def test_what_is_chosen(selection: Selection, expected: set[str]) -> None:
    assert chosen(selection) == expected


def test_patterns_are_no_plain_names() -> None:
    assert Selection(names=("/a", "/b/*")).plain_names == ("/a",)
