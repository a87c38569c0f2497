# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""ROS-lite's pipeline drives a vehicle from its mapfiles; how well and fast is for the bench."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.mapfile import load_mapfile, resolve
from rmw_manycore_py.native import _transport
from rmw_manycore_py.papers.roslite.variants import (
    AFTER,
    LOCALIZER,
    SEARCH,
    installed,
    with_split,
    with_vehicle,
    write,
)
from rmw_manycore_py.papers.roslite.vehicle.course import Course
from rmw_manycore_py.papers.roslite.vehicle.drive_log import DriveFigures
from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.peers.programs import forked_manycore
from support.processes.platforms import leftovers
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="a mapfile is about rmw_manycore"),
]

Start = Callable[..., Program]
LONG_S = 6 * TIMEOUT_S
LENGTH_M, WAYPOINTS, SCANS = 30.0, 100, 40
SMEM_FOR_TILES = 1 << 20
# Topics that have no part in the graph of a mapfile.
OF_EVERY_NODE = ("/rosout", "/parameter_events")


@pytest.fixture(scope="module")
def map_path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return Course(LENGTH_M, WAYPOINTS).write_map(tmp_path_factory.mktemp("map"))


def driving(variant: dict[str, Any], map_path: Path, directory: Path) -> Path:
    """Return the path of a mapfile with a vehicle that reports on some scans."""
    parameters = {
        "length": LENGTH_M,
        "waypoints": WAYPOINTS,
        "scans": SCANS,
        "report": str(directory / "drive.json"),
    }
    return write(with_vehicle(variant, map_path, **parameters), directory / "drive.yaml")


def edges_of(mapfile: Path) -> set[tuple[str, str, str, str]]:
    """Return node, role, topic and type of what a mapfile says."""
    return {
        (node.name.strip("/"), role, topic, type_name)
        for node in resolve(load_mapfile(mapfile)).nodes
        for role, topics in (("publisher", node.publish), ("subscription", node.subscribe))
        for topic, type_name in topics.items()
    }


def edges_on(platform: str) -> set[tuple[str, str, str, str]]:
    """Return the same of what runs, without the vehicle."""
    try:
        with _transport.Platform(platform) as view:
            endpoints = view.endpoints()
    except _transport.PlatformError:
        return set()  # not there, or not whole yet
    return {
        (endpoint.node_name, endpoint.kind, endpoint.topic, endpoint.type)
        for endpoint in endpoints
        if "/msg/" in endpoint.type  # not of a service
        and endpoint.topic not in OF_EVERY_NODE
        and endpoint.node_name != "vehicle"
    }


@pytest.mark.parametrize(
    "variant",
    [
        pytest.param(installed("ros_lite.map"), id="after", marks=pytest.mark.long),
        pytest.param(
            with_split(installed("ros_lite.map"), 2, 3),
            id="two derivatives, two searches and a merge",
            marks=pytest.mark.stress,
        ),
        pytest.param(installed("ros_lite_before.yaml"), id="before", marks=pytest.mark.stress),
    ],
)
def test_a_vehicle_is_driven(
    start: Start, platform: str, map_path: Path, tmp_path: Path, variant: dict[str, Any]
) -> None:
    expected = edges_of(write(variant, tmp_path / "alone.yaml"))
    run = start(forked_manycore("run", driving(variant, map_path, tmp_path)))
    wait_until(lambda: edges_on(platform) == expected, "all nodes", timeout_s=LONG_S)
    report = tmp_path / "drive.json"
    wait_until(report.exists, f"the report of the vehicle: {run!r}", timeout_s=LONG_S)
    with _transport.Platform(platform) as view:
        charged = {cluster.id: cluster.charged_bytes for cluster in view.clusters()}
    nodes = variant["nodes"].items()
    searching = {node["cluster"] for name, node in nodes if name.startswith(SEARCH)}
    assert {cluster for cluster, held in charged.items() if held} == searching
    assert max(charged.values()) <= SMEM_FOR_TILES
    figures = DriveFigures.read(report)
    assert figures.scans == SCANS
    assert figures.lost < SCANS
    assert figures.to_plan_ms
    assert figures.driven_m > 0.5
    assert max(figures.lateral_m) < 1.0
    assert all(1 <= passes <= 60 for passes in figures.passes)
    assert run.stop() == 0
    assert "Traceback" not in run.output
    assert leftovers(platform) == []


@pytest.mark.parametrize(
    ("node", "parameters", "said"),
    [
        (LOCALIZER, {"map": "nowhere.npz"}, "map nowhere.npz: there is no such file"),
        (LOCALIZER, {"derivatives": -1}, "parameter derivatives: expected at least 0, found -1"),
        (SEARCH, {"part": 1}, "parameter part: expected less than parts = 1, found 1"),
    ],
)
def test_bad_parameters_end_the_node_with_an_error(
    start: Start, platform: str, tmp_path: Path, node: str, parameters: dict[str, Any], said: str
) -> None:
    variant = installed(AFTER)
    one = {**variant["nodes"][node]}
    one["parameters"] = {**one["parameters"], **parameters}
    variant["nodes"] = {node: one}
    run = start(forked_manycore("run", write(variant, tmp_path / "bad.yaml")))
    assert run.wait(LONG_S) == 1
    assert said in run.output
    assert "Traceback" not in run.output


def test_tiles_that_fit_no_smem_are_an_error_with_the_size(
    start: Start, platform: str, map_path: Path, tmp_path: Path
) -> None:
    variant = installed(AFTER)
    variant["nodes"][SEARCH]["parameters"]["smem_bytes"] = 20_000
    run = start(forked_manycore("run", driving(variant, map_path, tmp_path)))
    run.wait_for("expected at most smem_bytes = 20000, found", LONG_S)
    run.stop()
