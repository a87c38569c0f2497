# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The doctor's checks of built packages and of isolated CPUs."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from rmw_manycore_interfaces import hash_of, own_prefix
from rmw_manycore_py.cli.doctor.built import check_built
from rmw_manycore_py.cli.doctor.finding import Verdict
from rmw_manycore_py.cli.doctor.scheduling import check_isolation

pytestmark = pytest.mark.unit

HEADER = "std_msgs/msg/Header"


@pytest.fixture(autouse=True)
def interfaces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MANYCORE_INTERFACES", str(tmp_path / "interfaces"))


def build(package: str, **dependencies: str | None) -> Path:
    """Write a manifest where programs look for built packages."""
    file = Path(own_prefix(), "share", package, "manifest.json")
    file.parent.mkdir(parents=True)
    manifest = {
        "package": package,
        "digest": "0",
        "types": [f"{package}/msg/A"],
        "available": 1,
        "source": "/src",
        "built": "2026-01-01T00:00:00+00:00",
        "seconds": 1.0,
        "dependencies": {name.replace("__", "/"): value for name, value in dependencies.items()},
    }
    file.write_text(json.dumps(manifest))
    return file


def test_built_packages_are_named() -> None:
    (none,) = check_built()
    assert none.found.startswith("none in ")
    build("own_msgs", std_msgs__msg__Header=hash_of(HEADER))
    (found,) = check_built()
    assert (found.verdict, found.found.split()[0]) == (Verdict.OK, "own_msgs")


def test_packages_that_programs_do_not_use_are_warned_of() -> None:
    build("own_msgs", std_msgs__msg__Header="RIHS01_of_long_ago")
    build("std_msgs")
    _, changed, hidden = check_built()
    assert changed.found == f"own_msgs: {HEADER} has changed since the package was built"
    assert changed.advice.startswith("`manycore interface build /src`, or ")
    assert hidden.found.startswith("std_msgs: programs use the package installed in ")
    assert hidden.advice == "`manycore interface remove std_msgs`"
    assert {changed.verdict, hidden.verdict} == {Verdict.WARNING}


def test_a_damaged_manifest_is_a_failure() -> None:
    build("own_msgs").write_text("{")
    (finding,) = check_built()
    assert finding.verdict is Verdict.FAILURE


def test_isolated_cpus_are_reported(tmp_path: Path) -> None:
    assert check_isolation(tmp_path).found == "none"
    cpu = min(os.sched_getaffinity(0))
    (tmp_path / "isolated").write_text(f"{cpu},1000\n")
    assert check_isolation(tmp_path).found == f"{cpu},1000; nodes may name {cpu} as host_cpu"
