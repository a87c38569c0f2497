# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Many generated parameter files and command lines, read here and by nodes.

tests/rmw/test_parameter_files.py has the first of them.
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
import rclpy
from comparing import FEW, MANY
from parameter_files import (
    Generator,
    compare_command_lines,
    compare_files,
    print_overrides,
    read_here,
    shown,
)
from support import IS_MANYCORE, peer_command

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore")

NODES = MANY // 50


@pytest.fixture
def context(platform):
    rclpy.init()
    yield rclpy.get_default_context()
    rclpy.shutdown()


def test_files_are_read_as_by_a_node(context, tmp_path: Path) -> None:
    assert compare_files(context, tmp_path, range(FEW, MANY))[1] == ""


def test_command_lines_give_what_launch_gives(context, tmp_path: Path) -> None:
    assert compare_command_lines(context, tmp_path, range(FEW, MANY)) == ""


def test_files_are_read_as_by_nodes_that_are_started_with_them(start, tmp_path: Path) -> None:
    file = tmp_path / "file.yaml"
    for number in range(NODES):
        file.write_bytes(Generator(number).file())
        found = read_here(file, "/ns/probe")
        words = ("--ros-args", "--params-file", str(file))
        node = start(peer_command(print_overrides, *words))
        if isinstance(found, dict):
            printed = node.wait_for(r"^(\[.*\])$")
            assert ast.literal_eval(printed[1]) == shown(found), f"file {number}"
            assert node.wait() == 0
        else:
            assert node.wait() != 0, f"file {number} is refused by us alone: {found}"
