# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameter files are read as the nodes read them; the stress tests have more of each."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from support.comparisons.comparing import FEW
from support.comparisons.parameter_files import (
    Generator,
    compare_command_lines,
    compare_files,
    print_overrides,
    read_here,
    shown,
)
from support.processes.commands import peer_command


def test_generated_files_are_read_as_by_a_node(node, tmp_path: Path) -> None:
    outcomes, wrong = compare_files(node.context, tmp_path, range(FEW))
    assert wrong == ""
    assert min(outcomes[kind] for kind in ("some", "none", "refused")) > FEW / 10, outcomes


def test_generated_command_lines_give_what_launch_gives(node, tmp_path: Path) -> None:
    assert compare_command_lines(node.context, tmp_path, range(FEW)) == ""


@pytest.mark.parametrize("number", range(3))
def test_a_file_is_read_as_by_a_node_that_is_started_with_it(start, tmp_path, number) -> None:
    file = tmp_path / "file.yaml"
    while not isinstance(found := read_here(file, "/ns/probe") if file.exists() else None, dict):
        file.write_bytes(Generator(number).file())
        number += 1000
    words = ("--ros-args", "--params-file", str(file))
    printed = start(peer_command(print_overrides, *words)).wait_for(r"\[.*\]")
    assert ast.literal_eval(printed[0]) == shown(found)
