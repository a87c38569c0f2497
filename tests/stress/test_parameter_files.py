# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Many generated parameter files and command lines, read here and by nodes.

tests/rmw/test_parameter_files.py has the first of them.
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from support import IS_MANYCORE, TIMEOUT_S
from support.comparisons.comparing import FEW, MANY
from support.comparisons.parameter_files import (
    Generator,
    print_comparison,
    print_overrides,
    read_here,
    shown,
)
from support.processes.commands import peer_command

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore")

NODES = MANY // 50


def test_inputs_are_read_as_by_a_node(start, tmp_path: Path) -> None:
    compared = start(peer_command(print_comparison, str(tmp_path), FEW, MANY))
    printed = compared.wait_for(r"^\[.*\]$", timeout_s=TIMEOUT_S + MANY / 10)
    assert ast.literal_eval(printed[0]) == ["", ""]


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
