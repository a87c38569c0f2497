# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The platform of a process without MANYCORE_PLATFORM."""

from __future__ import annotations

import pytest

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.native import _transport
from rmw_manycore_py.ros.domain import checked_platform, default_platform, is_elsewhere, ros_domain

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


def test_a_named_platform_is_that_of_one_domain(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MANYCORE_PLATFORM", "robot")
    assert [default_platform(domain) for domain in (None, 7, 9)] == ["robot", "robot", "domain-9"]
    monkeypatch.delenv("ROS_DOMAIN_ID")
    assert [default_platform(domain) for domain in (0, 7)] == ["robot", "domain-7"]


@pytest.mark.parametrize(
    ("domain", "expected"), [("7", False), ("07", False), ("0x7", False), ("8", True)]
)
def test_a_node_with_another_domain_than_its_run_is_elsewhere(domain: str, expected: bool) -> None:
    assert is_elsewhere({"ROS_DOMAIN_ID": domain}) is expected
    assert is_elsewhere({"A": "b"}) is False


@pytest.mark.parametrize(
    ("text", "domain"), [("", 0), ("08", None), ("010", 8), ("0x5", 5), (" +7", 7), ("232", 232)]
)
def test_a_domain_is_read_as_by_rcl(
    monkeypatch: pytest.MonkeyPatch, text: str, domain: int | None
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", text)
    if domain is None:
        with pytest.raises(ManycoreError, match=f"expected a number .*, found '{text}'"):
            ros_domain()
    else:
        assert ros_domain() == domain
        assert default_platform() == f"domain-{domain}"


@pytest.mark.parametrize("text", ["x", "5x", "-1", "233", " ", "0x", "9" * 30])
def test_what_is_no_domain_is_refused(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", text)
    with pytest.raises(ManycoreError, match=f"ROS_DOMAIN_ID: expected .*, found '{text}'"):
        ros_domain()


@pytest.mark.parametrize("text", ["abc", "08", "-", " "])
def test_a_platform_has_no_other_domain_than_its_nodes(
    monkeypatch: pytest.MonkeyPatch, text: str
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", text)
    with pytest.raises(ManycoreError, match=f"ROS_DOMAIN_ID: expected .*, found '{text}'"):
        default_platform()


NO_NAMES = (
    "",
    ".",
    "..",
    "a/b",
    "/",
    ".lock",
    "-x",
    "a b",
    "x" * 65,
    "a\0b",
    "b\u00fc",
    "\udcff",
    "x\n",
)


@pytest.mark.parametrize("name", NO_NAMES, ids=ascii)
def test_a_name_that_no_platform_has_is_refused(name: str) -> None:
    with pytest.raises(ManycoreError, match="--platform: expected a platform name") as refused:
        checked_platform(name, "--platform")
    assert refused.value.exit_status == EXIT_BAD_INPUT
    assert str(refused.value).isprintable()


@pytest.mark.parametrize("name", ["lock", "alive", "domain-0", "_", "x" * 64, "a.b-c"])
def test_python_and_the_transport_have_the_same_names(name: str) -> None:
    assert checked_platform(name, "--platform") == name
    assert _transport.platform_directory(name).endswith(f"/{name}")


@pytest.mark.parametrize("name", sorted(set(NO_NAMES) - {"\udcff"}), ids=ascii)
def test_the_transport_refuses_what_python_refuses(name: str) -> None:
    with pytest.raises(_transport.PlatformError, match="is not a valid platform name"):
        _transport.platform_directory(name)


def test_the_variable_is_checked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MANYCORE_PLATFORM", "../elsewhere")
    with pytest.raises(ManycoreError, match=r"MANYCORE_PLATFORM: .* found '../elsewhere'"):
        default_platform()
