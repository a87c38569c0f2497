# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The 24 nodes of the Autoware reference system, run from their mapfile."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

from rmw_manycore_py.native import _transport
from rmw_manycore_py.papers.reference_system.bench.text import losses_in, reports_in, values
from support import IS_MANYCORE, MAPFILES, TIMEOUT_S, wait_until
from support.peers.programs import forked_manycore
from support.processes.platforms import leftovers
from support.processes.program import Program
from support.samples import reference_system as described

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="a mapfile is about rmw_manycore"),
]

LONG_S = 6 * TIMEOUT_S
SLOWER = 4  # than the reference system: CPUs that are taken away for seconds have to catch up
CYCLES = 25  # of the planner, in ten seconds
PATIENT = {"crunch_ms": 0.0, "payload": "checked"}
# Other processes use the CPUs, too: depths that cover 16 seconds in which a node does not run, at
# 2.5 Hz, and 8 at 10 Hz, around EuclideanClusterSettings: more has no room in its cluster.
DEPTH, FAST_DEPTH = 40, 80
FAST = ("EuclideanClusterSettings", "EuclideanClusterDetector", "IntersectionOutput")
MESSAGE = "manycore_reference_msgs/msg/Message4kb"
COMMAND = "VehicleDBWSystem"
# Whose messages the last node's message has come from.
ON_THE_WAY = {
    *described.SENSORS,
    *described.TRANSFORMS,
    *described.FUSIONS,
    described.CYCLIC,
    described.INTERSECTION,
} - {"EuclideanClusterSettings"}


def depth_of(node: str) -> int:
    return FAST_DEPTH if node in FAST else DEPTH


def dsm_bytes(depth: int) -> int:
    """Return a fixed size: a topic DSM that grows needs the lock that starting nodes take."""
    return (depth + 10) * (4096 + 128)


@pytest.fixture
def mapfile(tmp_path: Path) -> Path:
    """Return the mapfile with depths and periods for a busy machine."""
    data = yaml.safe_load((MAPFILES / "autoware_reference.yaml").read_text())
    for name, node in data["nodes"].items():
        given = node["parameters"]
        node["parameters"] = {**given, **PATIENT, "depth": depth_of(name)}
        if "period_ms" in given:
            node["parameters"]["period_ms"] = SLOWER * given["period_ms"]
    data["topics"] = {
        f"/{topic}": {"type": MESSAGE, "topic_dsm_size": dsm_bytes(depth_of(name))}
        for name, topic in sorted(described.publishers())
    }
    path = tmp_path / "patient.yaml"
    path.write_text(yaml.safe_dump(data))
    return path


def output_of(run: Program, node: str) -> str:
    """Return the output of a node, without the prefix of each line."""
    parts = (line.split(" | ", 1) for line in run.lines if " | " in line)
    return "\n".join(part[1] for part in parts if part[0].strip() == node)


def endpoints(platform: str) -> tuple[described.Edges, described.Edges, set[str]]:
    """Return publishers, subscriptions and types of the topics of the reference system."""
    with _transport.Platform(platform) as view:
        ours = [e for e in view.endpoints() if e.type.startswith("manycore_reference_msgs/")]
    edges: dict[str, described.Edges] = {"publisher": set(), "subscription": set()}
    for endpoint in ours:
        edges[endpoint.kind].add((endpoint.node_name, endpoint.topic.strip("/")))
    return edges["publisher"], edges["subscription"], {endpoint.type for endpoint in ours}


def has_heard_all_for_long(run: Program) -> bool:
    """Return whether the last report is of messages of all nodes, and of enough cycles."""
    reports = reports_in(output_of(run, COMMAND))
    return (
        bool(reports)
        and set(reports[-1].sequences) == ON_THE_WAY
        and reports[-1].sequences[described.CYCLIC] >= CYCLES
    )


@pytest.mark.long
def test_24_nodes_run_for_ten_seconds_and_lose_nothing(
    start: Callable[..., Program], mapfile: Path, platform: str
) -> None:
    run = start(forked_manycore("run", mapfile))
    wait_until(lambda: has_heard_all_for_long(run), "messages of all nodes", LONG_S)
    assert endpoints(platform) == (described.publishers(), described.subscriptions(), {MESSAGE})
    with _transport.Platform(platform) as view:
        nodes = [process for process in view.processes() if process.core is not None]
        pinned = [os.sched_getaffinity(process.pid) for process in nodes]
        lost = {e.topic: e.counters.lost for e in view.endpoints() if e.counters.lost}
    assert len({(process.cluster, process.core) for process in nodes}) == 24
    assert {len(cpus) for cpus in pinned} == {1}
    assert lost == {}
    assert run.stop() == 0
    assert leftovers(platform) == []
    for node in (*described.TRANSFORMS, *described.FUSIONS, described.CYCLIC, COMMAND):
        assert losses_in(output_of(run, node)) == [], node
    reports = reports_in(output_of(run, COMMAND))
    assert values(reports, "hot path drops")[-1] == 0  # the end may cut the last report off
