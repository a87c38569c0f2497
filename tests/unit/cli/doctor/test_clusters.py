# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The doctor's checks of clusters, memory policies, cpusets and resctrl."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.cli.doctor.clusters import (
    check_clusters,
    check_cpuset,
    check_resctrl,
    memory_policy,
)
from rmw_manycore_py.cli.doctor.finding import Verdict
from rmw_manycore_py.platform.machine.memory_policy import policy_refusal

pytestmark = pytest.mark.unit


def test_this_machine_is_reported_without_failures() -> None:
    findings = [*check_clusters()]
    assert [one.subject for one in findings] == [
        "clusters of the machine",
        "NUMA memory",
        "cpusets (cgroup v2)",
        "cache and bandwidth (resctrl)",
    ]
    assert Verdict.FAILURE not in {one.verdict for one in findings}


def test_a_refused_memory_policy_matters_with_several_nodes() -> None:
    refused = "Operation not permitted"
    assert memory_policy({0, 1}, refused).verdict is Verdict.WARNING
    assert memory_policy({0, 1}, refused).advice.startswith("start the container with")
    assert memory_policy({0, 1}, "").found == "2 nodes; mbind: allowed"
    assert memory_policy({None}, refused).verdict is Verdict.OK


def test_the_policy_of_a_page_may_be_set_here() -> None:
    assert policy_refusal() == ""


@pytest.mark.parametrize(
    ("controllers", "found"),
    [
        (None, "cgroup v2 is not mounted"),
        ("cpu memory", "not delegated to this session"),
        ("cpuset cpu", "delegated to this session"),
    ],
)
def test_cpusets_are_those_of_the_own_group(
    controllers: str | None, found: str, tmp_path: Path
) -> None:
    own = tmp_path / "cgroup"
    own.write_text("4:memory:/a\n0::/user.slice/me\n")
    group = tmp_path / "mount/user.slice/me"
    group.mkdir(parents=True)
    if controllers is not None:
        (tmp_path / "mount/cgroup.controllers").write_text("cpuset cpu memory\n")
        (group / "cgroup.controllers").write_text(f"{controllers}\n")
        (group / "cgroup.subtree_control").touch()
    assert check_cpuset(own, tmp_path / "mount").found == found


def test_resctrl_is_reported_with_what_the_cpu_has(tmp_path: Path) -> None:
    cpuinfo, filesystems, mount = (tmp_path / name for name in ("cpuinfo", "fs", "resctrl"))
    cpuinfo.write_text("model name\t: x\nflags\t\t: fpu cat_l3 mba sse\n")
    assert check_resctrl(cpuinfo, filesystems, mount).found == (
        "CPU has cat_l3, mba, the kernel lacks resctrl"
    )
    filesystems.write_text("nodev\tsysfs\nnodev\tresctrl\n")
    available = check_resctrl(cpuinfo, filesystems, mount)
    assert available.found == "available (cat_l3, mba), not mounted"
    assert available.advice.endswith(f"`mount -t resctrl resctrl {mount}` as root")
    mount.mkdir()
    (mount / "schemata").touch()
    assert check_resctrl(cpuinfo, filesystems, mount).found == f"mounted at {mount}"
