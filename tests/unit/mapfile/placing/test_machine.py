# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Placements on the clusters of a machine."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from rmw_manycore_py.cli.map.drawing import drawing_of
from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile import Placement, load_mapfile
from rmw_manycore_py.mapfile.format.mapfile import Mapfile
from rmw_manycore_py.mapfile.placing.cores import assign_cores, assign_cpus
from rmw_manycore_py.mapfile.placing.notices import unbound_memory
from rmw_manycore_py.platform.topology import Core, of_machine
from support.samples.sysfs import clusters_in, description_of

pytestmark = pytest.mark.unit


def mapfile_on(machine: str, directory: Path, *nodes: str) -> Mapfile:
    """Return a mapfile that was loaded on another machine."""
    path = directory / "map.yaml"
    lines = (f"  n{number}: {{{node}, command: [true]}}\n" for number, node in enumerate(nodes))
    path.write_text(f"platform: bostan\nnodes:\n{''.join(lines)}")
    topology = of_machine(clusters_in(description_of(machine), directory / machine))
    return replace(load_mapfile(path), topology=topology)


def cpus_on(mapfile: Mapfile) -> dict[Core, int]:
    return assign_cpus(mapfile, [*assign_cores(mapfile).values()], (), cpus=(0, 1))


def test_a_core_is_a_cpu_of_its_cluster(tmp_path: Path) -> None:
    """Also of the receive thread, and whatever CPUs the process that checks may use."""
    mapfile = mapfile_on("epyc_7453", tmp_path, "cluster: 2", "cluster: 2, core: 7", "cluster: 4")
    assert cpus_on(mapfile) == {
        Core(2, 0): 7,
        Core(2, 1): 8,
        Core(2, 7): 35,
        Core(4, 0): 21,
        Core(4, 1): 22,
    }


def test_a_host_cpu_that_is_another_core_is_refused(tmp_path: Path) -> None:
    same = mapfile_on("orin", tmp_path, "cluster: 3, core: 1, host_cpu: 9")
    assert cpus_on(same)[Core(3, 1)] == 9
    other = mapfile_on("orin", tmp_path, "cluster: 3, core: 1, host_cpu: 2")
    expected = "expected 9, which cluster 3 core 1 of this machine is, found 2"
    with pytest.raises(MapfileError, match=expected):
        cpus_on(other)


def test_the_drawing_has_each_cluster_with_its_cpus(tmp_path: Path) -> None:
    mapfile = mapfile_on("rk3588", tmp_path, "cluster: 2", "cluster: 2, core: 3")
    placement = Placement("p", mapfile.topology, (), (), (), cpus_on(mapfile), None, ())
    assert [*drawing_of(placement)] == [
        "this machine: R receive thread, * nodes or workers, . free",
        "cluster 1: L3 3 MiB, NUMA node 0, capacity 397 of 1024",
        "  .0   .1   .2   .3",
        "cluster 2: L3 3 MiB, NUMA node 0",
        "  R4   *5   .6   *7",
    ]


def test_memory_that_cannot_be_bound_is_noticed_where_there_are_nodes(tmp_path: Path) -> None:
    two_nodes = mapfile_on("epyc_9654_2s", tmp_path, "cluster: 1").topology
    one_node = mapfile_on("altra_80", tmp_path, "cluster: 1").topology
    refused = "Operation not permitted"
    (notice,) = unbound_memory(two_nodes, lambda: refused)
    assert notice.startswith("the memory of clusters is not bound to their NUMA nodes (mbind: ")
    assert [*unbound_memory(one_node, lambda: refused)] == []
    assert [*unbound_memory(two_nodes, lambda: "")] == []
