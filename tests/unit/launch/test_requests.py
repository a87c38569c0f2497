# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Requests to a supervisor, whose keys and values are checked."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from rmw_manycore_py.launch.requests import Resume

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("topic", ["/a\nover", "/a b", "a"])
def test_the_topic_of_a_step_is_a_full_name(topic: str) -> None:
    Resume(do="resume", topic="/robot/scan_1")
    with pytest.raises(ValidationError):
        Resume(do="resume", topic=topic)


@pytest.mark.parametrize("for_s", [0.0, float("inf"), float("nan"), 1e12])
def test_a_step_is_as_long_as_the_clock_can_express(for_s: float) -> None:
    Resume(do="resume", for_s=1e9)
    with pytest.raises(ValidationError):
        Resume(do="resume", for_s=for_s)
