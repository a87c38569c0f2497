# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Installed types and their definitions."""

from __future__ import annotations

import pytest
from click.testing import CliRunner

from rmw_manycore_py.cli.interface.text import definition
from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.errors import ManycoreError

pytestmark = pytest.mark.unit


def show(*words: str) -> list[str]:
    return CliRunner().invoke(cli, ["interface", *words]).output.splitlines()


def test_a_service_has_two_parts() -> None:
    assert show("show", "std_srvs/srv/SetBool", "--no-comments") == [
        "bool data",
        "---",
        "bool success",
        "string message",
    ]
    assert show("show", "std_srvs/srv/SetBool")[0] == (
        "bool data # e.g. for hardware enabling / disabling"
    )


def test_nested_types_are_indented() -> None:
    assert show("show", "std_msgs/msg/UInt8MultiArray", "--no-comments") == [
        "MultiArrayLayout  layout",
        "\tMultiArrayDimension[] dim",
        "\t\tstring label",
        "\t\tuint32 size",
        "\t\tuint32 stride",
        "\tuint32 data_offset",
        "uint8[]           data",
    ]
    stamped = show("show", "geometry_msgs/msg/PointStamped", "--no-comments")
    assert stamped[:3] == [
        "std_msgs/Header header",
        "\tbuiltin_interfaces/Time stamp",
        "\t\tint32 sec",
    ]


def test_types_that_are_not_there() -> None:
    for name, expected in (
        ("Odometry", "expected package/msg/Name"),
        ("no_such_msgs/msg/A", "Unknown package 'no_such_msgs'"),
        ("std_msgs/msg/A", "Could not find the interface 'std_msgs/msg/A'"),
    ):
        with pytest.raises(ManycoreError, match=expected):
            list(definition(name))


def test_packages_and_their_types() -> None:
    assert show("package", "std_srvs") == [
        "std_srvs/srv/Empty",
        "std_srvs/srv/SetBool",
        "std_srvs/srv/Trigger",
    ]
    assert show("package", "std_srvs", "--only-msgs") == []
    assert "not installed" in CliRunner().invoke(cli, ["interface", "package", "none"]).output
    packages = show("packages")
    assert {"std_msgs", "std_srvs", "test_msgs"} <= set(packages)
    assert "test_msgs" in show("packages", "--only-actions")
    assert "std_srvs" not in show("packages", "--only-actions")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("std_srvs/srv/SetBool", "data: false\n"),
        ("test_msgs/action/Fibonacci", "order: 0\n"),
        ("geometry_msgs/msg/Point", "x: 0.0\ny: 0.0\nz: 0.0\n"),
    ],
)
def test_values_to_copy(name: str, text: str) -> None:
    assert CliRunner().invoke(cli, ["interface", "proto", name]).output == f'"{text}"\n'
    assert show("proto", "--no-quotes", name)[:-1] == text.splitlines()


def test_types_are_listed_by_kind() -> None:
    assert "    test_msgs/action/Fibonacci" in show("list", "-a")
    lines = show("list")
    assert [line for line in lines if line.endswith(":")] == ["Messages:", "Services:", "Actions:"]
    assert "    std_msgs/msg/String" in lines[: lines.index("Services:")]
    assert show("list", "-s")[0] == "Services:"
