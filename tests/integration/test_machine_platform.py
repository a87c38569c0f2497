# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The platform `machine`: where its processes run, and which memory the kernel gives them."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from rmw_manycore_py.native._transport import Configurator, Process
from rmw_manycore_py.platform.machine.memory_policy import policy_refusal
from rmw_manycore_py.platform.topology import machine_clusters
from support import IS_MANYCORE
from support.peers.programs import forked_manycore
from support.processes.platforms import PLATFORMS

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore"),
]

NODE = """
import os, pathlib
import rclpy
rclpy.init()
node = rclpy.create_node("here")
publisher = node.create_publisher(__import__("std_msgs.msg").msg.String, "t", 1)
print("runs on", sorted(os.sched_getaffinity(0)), flush=True)
rclpy.spin(node)
"""


def policies(pid: int | str, segment: Path) -> set[str]:
    """Return the memory policies of a segment in a process (numa_maps)."""
    lines = Path(f"/proc/{pid}/numa_maps").read_text().splitlines()
    return {line.split()[1] for line in lines if f"file={segment} " in f"{line} "}


def receive_thread_of(cluster: int, segment: Path) -> int:
    """Return the process of a cluster's receive thread that maps a segment."""
    for maps in Path("/proc").glob("[0-9]*/maps"):
        try:
            name = (maps.parent / "comm").read_text().strip()
            if name == f"manycore_rt_{cluster}" and str(segment) in maps.read_text():
                return int(maps.parent.name)
        except OSError:
            continue
    raise AssertionError(f"no receive thread of cluster {cluster}")


def test_a_run_on_this_machine_binds_cpus_and_memory(start, tmp_path: Path, platform: str) -> None:
    """Node and receive thread have their CPUs; SMEM is taken from the cluster's NUMA node."""
    (tmp_path / "node.py").write_text(NODE)
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text("platform: machine\nnodes:\n  here: {cluster: 1, script: node.py}\n")
    run = start(forked_manycore("run", mapfile))
    cluster = machine_clusters()[0]
    run.wait_for(rf"runs on \[{cluster.cpus[1]}\]")
    segment = PLATFORMS / platform / "cluster-1"
    receiver = receive_thread_of(1, segment)
    assert os.sched_getaffinity(receiver) == {cluster.cpus[0]}
    if cluster.node is not None and not policy_refusal():
        assert policies(receiver, segment) == {f"prefer:{cluster.node}"}
    assert run.stop() == 0


@pytest.mark.skipif(policy_refusal() != "", reason="the system refuses memory policies")
@pytest.mark.parametrize(("cluster", "policy"), [(1, "default"), (2, "prefer:0")])
def test_memory_is_from_the_node_of_its_cluster(platform: str, cluster: int, policy: str) -> None:
    """Of a cluster without a node it is from anywhere."""
    configured = Configurator(
        platform,
        clusters=2,
        cores_per_cluster=4,
        smem_bytes=8 << 20,
        host_cpu_of_receive_thread={},
        topics=[],
        numa_node_of_cluster={2: 0},
    )
    with configured, Process(platform, cluster=cluster):
        assert policies("self", PLATFORMS / platform / f"cluster-{cluster}") == {policy}
