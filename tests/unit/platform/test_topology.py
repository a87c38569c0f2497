# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
from pathlib import Path

import pytest

from rmw_manycore_py.platform.topology import (
    MIB,
    Core,
    assign_host_cpus,
    host_smem_size,
    isolated_cpus,
    profile,
    share_of_memory,
)

pytestmark = pytest.mark.unit


def test_coolidge_is_five_clusters_of_sixteen_cores_with_4_mib() -> None:
    coolidge = profile("coolidge")
    assert [(c.id, c.cores, c.smem_size) for c in coolidge.clusters] == [
        (number, 16, 4 * MIB) for number in range(1, 6)
    ]


def test_bostan_has_four_io_clusters_after_its_sixteen() -> None:
    bostan = profile("bostan")
    assert [c.cores for c in bostan.clusters] == [16] * 16 + [4] * 4
    assert bostan.smem_size == 2 * MIB


def test_first_and_last_core_are_reserved_and_of_io_clusters_the_first() -> None:
    bostan = profile("bostan")
    assert bostan.clusters[0].reserved == {0, 15}
    assert bostan.clusters[16].reserved == {0}


def test_the_host_gives_of_its_shared_memory() -> None:
    status = os.statvfs("/dev/shm")
    assert host_smem_size(5) == share_of_memory(status.f_blocks * status.f_frsize, 5)


@pytest.mark.parametrize(
    ("shared_mib", "smem_mib"), [(0, 1024), (1, 1), (64, 48), (2048, 1024), (24 * 1024, 2457)]
)
def test_clusters_share_what_is_little(shared_mib: int, smem_mib: int) -> None:
    assert share_of_memory(shared_mib * MIB, 5) == smem_mib * MIB


def test_used_cores_spread_over_the_cpus_in_order() -> None:
    used = [Core(1, 1), Core(3, 1), Core(2, 9), Core(1, 0)]
    assert list(assign_host_cpus(used, {}, (0, 1)).values()) == [0, 1, 0, 1]


def test_a_cpu_that_was_asked_for_counts_as_busy() -> None:
    used = [Core(1, 1), Core(1, 2), Core(1, 3)]
    assigned = assign_host_cpus(used, {Core(1, 2): 0}, (0, 1, 2))
    assert assigned == {Core(1, 2): 0, Core(1, 1): 1, Core(1, 3): 2}


def test_isolated_cpus_are_those_that_the_cpuset_has(tmp_path: Path) -> None:
    """CPUs of the machine may be named even if outside the affinity mask; others may not."""
    assert isolated_cpus(tmp_path) == ()
    before = os.sched_getaffinity(0)
    first = min(before)
    (tmp_path / "isolated").write_text(f"{first},1000\n")
    try:
        os.sched_setaffinity(0, {max(before)})  # as in a shell where `first` is isolated
        assert isolated_cpus(tmp_path) == (first,)
        assert os.sched_getaffinity(0) == {max(before)}
    finally:
        os.sched_setaffinity(0, before)
