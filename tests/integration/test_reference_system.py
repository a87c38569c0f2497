# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The 24 nodes of the Autoware reference system, run from their mapfile."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
import reference_system as described
import yaml
from support import IS_MANYCORE, MAPFILES, Program, leftovers, manycore_command, wait_until

from rmw_manycore_py import _transport
from rmw_manycore_py.bench.reference.text import losses_in, reports_in

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="a mapfile is about rmw_manycore"),
]

CYCLES = 100  # of the planner, in ten seconds
# Here others use the CPUs as well: what is kept for a node is enough for a second without one.
PATIENT = {"depth": 40, "crunch_ms": 0.0, "payload": "checked"}
# Room for it: a topic DSM that grows meanwhile needs the lock that starting nodes take.
TOPIC_DSM_BYTES = 50 * (4096 + 128)
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


@pytest.fixture
def mapfile(tmp_path: Path) -> Path:
    """Return the mapfile, for nodes that are patient."""
    data = yaml.safe_load((MAPFILES / "autoware_reference.yaml").read_text())
    for node in data["nodes"].values():
        node["parameters"] = {**node["parameters"], **PATIENT}
    topics = {f"/{topic}" for _, topic in described.publishers()}
    data["topics"] = {
        topic: {"type": MESSAGE, "topic_dsm_size": TOPIC_DSM_BYTES} for topic in sorted(topics)
    }
    path = tmp_path / "patient.yaml"
    path.write_text(yaml.safe_dump(data))
    return path


def output_of(run: Program, node: str) -> str:
    """Return what a node printed, without the prefix of its lines."""
    parts = (line.split(" | ", 1) for line in run.lines if " | " in line)
    return "\n".join(part[1] for part in parts if part[0].strip() == node)


def endpoints(platform: str) -> tuple[described.Edges, described.Edges, set[str]]:
    """Return publishers, subscriptions and types of the reference system's topics."""
    with _transport.Platform(platform) as view:
        ours = [e for e in view.endpoints() if e.type.startswith("manycore_reference_msgs/")]
    edges: dict[str, described.Edges] = {"publisher": set(), "subscription": set()}
    for endpoint in ours:
        edges[endpoint.kind].add((endpoint.node_name, endpoint.topic.strip("/")))
    return edges["publisher"], edges["subscription"], {endpoint.type for endpoint in ours}


def has_heard_all_for_long(run: Program) -> bool:
    """Tell whether the last report is of messages of all nodes, and of enough cycles."""
    reports = reports_in(output_of(run, COMMAND))
    return (
        bool(reports)
        and set(reports[-1].sequences) == ON_THE_WAY
        and reports[-1].sequences[described.CYCLIC] >= CYCLES
    )


def test_24_nodes_run_for_ten_seconds_and_lose_nothing(
    start: Callable[..., Program], mapfile: Path, platform: str
) -> None:
    run = start(manycore_command("run", mapfile))
    wait_until(lambda: has_heard_all_for_long(run), "messages of all nodes", timeout_s=120)
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
    last = reports_in(output_of(run, COMMAND))[-1]
    assert last.statistics["hot path drops"] == 0
