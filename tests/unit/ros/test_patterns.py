# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import pytest

from rmw_manycore_py.ros.patterns import is_pattern, matches

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(
    ("pattern", "fitting", "others"),
    [
        ("/camera/*", ["/camera/left"], ["/camera", "/camera/left/image", "/lidar/left"]),
        ("/camera/*/image", ["/camera/left/image"], ["/camera/image", "/camera/a/b/image"]),
        ("/cam*_raw", ["/camera_raw", "/cam_raw"], ["/camera_raw2", "/my_camera_raw"]),
        ("/**", ["/a", "/a/b/c"], ["/_a", "/a/_b"]),
        ("/camera/**", ["/camera", "/camera/a/b"], ["/camera2", "/camera/_a"]),
        ("/**/image", ["/image", "/a/image", "/a/b/image"], ["/image/a", "/_a/image"]),
        ("/**/a/**", ["/a", "/b/a/c", "/a/a"], ["/b", "/b/c"]),
        ("/_*", ["/_a"], ["/a"]),
        ("/a", ["/a"], ["/b", "/a/b"]),
    ],
)
def test_names_that_fit(pattern: str, fitting: list[str], others: list[str]) -> None:
    assert [name for name in fitting if not matches(pattern, name)] == []
    assert [name for name in others if matches(pattern, name)] == []


def test_what_every_node_publishes_fits_nothing() -> None:
    assert not matches("/**", "/rosout")
    assert not matches("/parameter*", "/parameter_events")
    assert matches("/**", "/camera/rosout")


def test_a_pattern_of_many_stars_is_soon_tried() -> None:
    assert not matches("/**" * 80 + "/b", "/a" * 100)
    assert not matches("/" + "*a" * 100 + "b", "/" + "a" * 240)


def test_a_star_makes_a_pattern() -> None:
    assert is_pattern("/a*")
    assert not is_pattern("/a")
