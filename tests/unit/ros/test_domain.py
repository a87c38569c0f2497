# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The platform of a process that is told none."""

from __future__ import annotations

import pytest

from rmw_manycore_py.ros.domain import default_platform

pytestmark = pytest.mark.unit


@pytest.fixture(autouse=True)
def environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("MANYCORE_PLATFORM", raising=False)
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")


def test_the_domain_is_the_platform() -> None:
    assert default_platform() == "domain-7"


def test_without_a_domain_it_is_that_of_domain_0(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "")
    assert default_platform() == "domain-0"


def test_a_domain_that_rcl_was_given_wins_over_the_environment() -> None:
    assert default_platform(9) == "domain-9"


def test_a_named_platform_wins_over_every_domain(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MANYCORE_PLATFORM", "robot")
    assert (default_platform(), default_platform(9)) == ("robot", "robot")
