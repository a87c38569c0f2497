# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Clusters of real machines, whose sysfs was written down from published facts."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.platform.machine.clusters import HostCluster, clusters_of
from rmw_manycore_py.platform.machine.pairs import KINDS, OTHER_NODE, nearest_pairs
from rmw_manycore_py.platform.machine.sysfs import cpus_of_list, list_of_cpus, read_cpus
from rmw_manycore_py.platform.topology import (
    Core,
    machine_clusters,
    of_machine,
    profile,
    usable_cpus,
)
from support.samples.sysfs import MACHINES, clusters_in, description_of, write_sysfs

pytestmark = pytest.mark.unit

# CPUs in the order of the cores, and what they have in common.
EXPECTED = {
    "epyc_7453": [
        ("0-6 28-34", "L3 16 MiB, NUMA node 0"),
        ("7-13 35-41", "L3 16 MiB, NUMA node 0"),
        ("14-20 42-48", "L3 16 MiB, NUMA node 0"),
        ("21-27 49-55", "L3 16 MiB, NUMA node 0"),
    ],
    "epyc_9654_2s": [
        (f"{first}-{first + 7} {first + 192}-{first + 199}", f"L3 32 MiB, NUMA node {first // 96}")
        for first in range(0, 192, 8)
    ],
    "altra_80": [("0-79", "NUMA node 0")],
    "grace_72": [("0-71", "L3 114 MiB, NUMA node 0")],
    "orin": [("0-3", "L3 2 MiB"), ("4-7", "L3 2 MiB"), ("8-11", "L3 2 MiB")],
    "rk3588": [
        ("0-3", "L3 3 MiB, NUMA node 0, capacity 397 of 1024"),
        ("4-7", "L3 3 MiB, NUMA node 0"),
    ],
}


def machine(name: str, directory: Path, usable: str | None = None) -> tuple[HostCluster, ...]:
    """Return the clusters of a machine, with some of its CPUs."""
    return clusters_in(description_of(name), directory, usable)


def cpus(text: str) -> tuple[int, ...]:
    return tuple(cpu for part in text.split() for cpu in cpus_of_list(part))


def test_every_machine_has_its_expectation() -> None:
    assert {file.stem for file in MACHINES.glob("*.txt")} == set(EXPECTED)


@pytest.mark.parametrize("name", EXPECTED)
def test_clusters_are_those_of_the_machine(name: str, tmp_path: Path) -> None:
    found = [(cluster.cpus, cluster.text) for cluster in machine(name, tmp_path)]
    assert found == [(cpus(listed), text) for listed, text in EXPECTED[name]]


def test_memory_is_in_the_numa_node_of_the_cpus(tmp_path: Path) -> None:
    nodes = [cluster.node for cluster in machine("epyc_9654_2s", tmp_path)]
    assert nodes == [0] * 12 + [1] * 12


def test_without_numa_clusters_have_no_node(tmp_path: Path) -> None:
    assert {cluster.node for cluster in machine("orin", tmp_path)} == {None}


def test_clusters_have_only_usable_cpus(tmp_path: Path) -> None:
    """A cpuset leaves whole clusters out, and one of which a single CPU remains."""
    found = machine("epyc_7453", tmp_path, usable="5-7,14-20,42")
    assert [cluster.cpus for cluster in found] == [(5, 6), (*range(14, 21), 42)]


def test_a_prime_core_joins_the_next_slower_ones(tmp_path: Path) -> None:
    description = description_of("rk3588").replace("1024 4-7", "800 4-6\ncapacity 1024 7")
    found = clusters_in(description, tmp_path)
    assert [(cluster.cpus, cluster.capacity) for cluster in found] == [
        ((0, 1, 2, 3), 397),
        ((4, 5, 6, 7), 800),
    ]


def test_cpus_that_share_a_node_alone_form_one_cluster(tmp_path: Path) -> None:
    """As in a virtual machine of two CPUs whose caches are not shown."""
    found = clusters_in("cores 0-1\nnode 0 0-1", tmp_path)
    assert [(cluster.cpus, cluster.text) for cluster in found] == [((0, 1), "NUMA node 0")]


def test_cores_of_a_machine_are_its_cpus(tmp_path: Path) -> None:
    topology = of_machine(machine("epyc_7453", tmp_path))
    assert [cluster.cores for cluster in topology.clusters] == [14] * 4
    assert topology.host_cpu(Core(2, 0)) == 7  # of the receive thread
    assert topology.host_cpu(Core(2, 7)) == 35
    assert topology.host_cpu(Core(2, 14)) is None
    assert profile("coolidge").host_cpu(Core(2, 0)) is None


def test_a_machine_without_two_usable_cpus_is_no_platform(tmp_path: Path) -> None:
    with pytest.raises(ManycoreError, match="choose the platform 'host'"):
        of_machine(machine("rk3588", tmp_path, usable="3"))


def test_this_machine_has_clusters_of_its_usable_cpus() -> None:
    found = [cpu for cluster in machine_clusters() for cpu in cluster.cpus]
    assert sorted(found) == sorted(set(found))
    assert set(found) <= set(usable_cpus())


@pytest.mark.parametrize(
    ("text", "listed"), [("", ()), ("3", (3,)), ("0-2,5", (0, 1, 2, 5)), ("1,3-4", (1, 3, 4))]
)
def test_lists_of_cpus_are_those_of_the_kernel(text: str, listed: tuple[int, ...]) -> None:
    assert cpus_of_list(f"{text}\n") == listed
    assert list_of_cpus(listed) == text


@pytest.mark.parametrize(
    ("name", "pairs"),
    [
        ("epyc_7453", [(0, 0), (0, 28), (0, 1), (0, 7)]),
        ("epyc_9654_2s", [(0, 0), (0, 192), (0, 1), (0, 8), (0, 96)]),
        ("altra_80", [(0, 0), (0, 1)]),
        ("rk3588", [(0, 0), (0, 1), (0, 4)]),
    ],
)
def test_pairs_of_cpus_are_the_nearest_of_each_kind(
    name: str, pairs: list[tuple[int, int]], tmp_path: Path
) -> None:
    cpus = read_cpus(write_sysfs(description_of(name), tmp_path))
    found = nearest_pairs(cpus, clusters_of(cpus))
    assert [*found.values()] == pairs
    assert [*found] == [kind for kind in KINDS if kind in found]
    assert (OTHER_NODE in found) == (name == "epyc_9654_2s")
