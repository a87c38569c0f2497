# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One small file per kind of error; its comments state the expected errors."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from rmw_manycore_py.errors import EXIT_BAD_INPUT, MapfileError
from rmw_manycore_py.mapfile import check
from rmw_manycore_py.mapfile.launch_file import read_launch_file

pytestmark = pytest.mark.unit

HERE = Path(__file__).parent
NO_FIXTURES = (
    "quiet.py",
    "imports_missing_types.py",
    "mixed_list_in_param_file.params.yaml",
    "ruff.toml",
)
EXPECTED = re.compile(r"expected: (.*?)(?: -->)?$", re.MULTILINE)


def expected_errors(file: Path) -> list[str]:
    lines = (line for line in file.read_text().splitlines() if line.startswith(("# ", "<!-- ")))
    return [match[1] for line in lines if (match := EXPECTED.search(line))]


def files(directory: str) -> list[Path]:
    found = (file for file in (HERE / directory).iterdir() if file.is_file())
    return sorted(file for file in found if expected_errors(file))


def errors(error: MapfileError, directory: str) -> list[str]:
    text = str(error).replace(f"{HERE / directory}/", "").replace(f"{HERE}/", "")
    return text.splitlines()


@pytest.mark.parametrize("file", files("invalid"), ids=lambda file: file.name)
def test_a_wrong_mapfile_is_refused(file: Path) -> None:
    with pytest.raises(MapfileError) as caught:
        check(file)
    assert errors(caught.value, "invalid") == expected_errors(file)
    assert caught.value.exit_status == EXIT_BAD_INPUT


@pytest.mark.parametrize("file", files("invalid_launch"), ids=lambda file: file.name)
def test_a_wrong_launch_file_is_refused(file: Path) -> None:
    with pytest.raises(MapfileError) as caught:
        read_launch_file(file)
    assert errors(caught.value, "invalid_launch") == expected_errors(file)


def test_every_fixture_names_its_error() -> None:
    silent = [
        file.name
        for directory in ("invalid", "invalid_launch")
        for file in (HERE / directory).iterdir()
        if file.is_file() and file.name not in NO_FIXTURES and not expected_errors(file)
    ]
    assert silent == []


def test_a_missing_mapfile_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MapfileError, match="expected a readable text file, found No such file"):
        check(tmp_path / "absent.yaml")


def test_a_host_cpu_that_is_not_usable_is_refused(tmp_path: Path) -> None:
    mapfile = tmp_path / "mapfile.yaml"
    mapfile.write_text("nodes:\n  a: {cluster: 1, module: this, host_cpu: 100000}\n")
    with pytest.raises(MapfileError, match=r"mapfile.yaml:2: nodes.a.host_cpu: expected a CPU"):
        check(mapfile)


def test_a_host_cpu_of_the_bridge_that_is_not_usable_is_refused(tmp_path: Path) -> None:
    cpu = min(os.sched_getaffinity(0))
    mapfile = tmp_path / "mapfile.yaml"
    mapfile.write_text(
        f"bridge: {{host_cpu: [{cpu}, 100000]}}\nnodes:\n  a: {{cluster: 1, module: this}}\n"
    )
    with pytest.raises(MapfileError, match=r"mapfile.yaml:1: bridge.host_cpu: expected a CPU .*"):
        check(mapfile)
