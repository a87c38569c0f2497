# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`mapfiles/whill.yaml` is Fig. 11 of ROS-lite2, compared with the paper's sentences by number.

"rmw_manycore [...] occupies two cores in each cluster. In Cluster 1, there is bridge_node. In
Cluster 2, each offloaded node except ndt_scan_matcher is assigned to a core. Cluster 3 parallelizes
ndt_scan_matcher and allocates it to 12 cores, which is the maximum number of cores, excluding
rmw_noc and one core for spare. Cluster 4 is not used. Cluster 5 is used when the number of nodes to
offload is increased."
"""

from __future__ import annotations

import json
from typing import Any

import pytest
from click.testing import CliRunner

from rmw_manycore_py.cli.main import cli
from support import MAPFILES

pytestmark = pytest.mark.unit

MAPFILE = MAPFILES / "whill.yaml"
CLUSTERS, CORES, RESERVED_CORES, SPARE_CORES, MATCHER_CORES = 5, 16, 2, 1, 12
TABLE_I = {
    *("pointcloud_map_loader", "ndt_scan_matcher", "ekf_localizer", "simple_trajectory_follower"),
    *("vehicle_cmd_gate", "static_trajectory_publisher", "pose_initializer_node"),
    *("whill_interface", "vehicle_velocity_converter_node", "gyro_odometer"),
}


@pytest.fixture(scope="module")
def shown() -> dict[str, Any]:
    result = CliRunner().invoke(cli, ["map", "show", str(MAPFILE), "--json"])
    assert result.exit_code == 0, result.output
    data: dict[str, Any] = json.loads(result.stdout)
    return data


def test_the_nodes_are_those_of_table_i(shown):
    assert {node["name"].strip("/") for node in shown["nodes"]} == TABLE_I


def test_rmw_manycore_has_two_cores_of_each_cluster(shown):
    assert len(shown["clusters"]) == CLUSTERS
    for cluster in shown["clusters"]:
        assert cluster["cores"] == CORES
        assert len(cluster["reserved_cores"]) == RESERVED_CORES


def test_cluster_1_has_the_bridge_alone(shown):
    assert all(node["cluster"] != 1 for node in shown["nodes"])
    (processes,) = shown["bridge"]["cores"]
    assert len(processes) == 2
    assert {cluster for cluster, _ in processes} == {1}


def test_cluster_2_has_a_core_for_each_node_but_the_matcher(shown):
    others = [node for node in shown["nodes"] if node["name"].strip("/") != "ndt_scan_matcher"]
    assert {node["cluster"] for node in others} == {2}
    assert len({node["core"] for node in others}) == len(others) == len(TABLE_I) - 1


def test_cluster_3_has_the_matcher_on_the_cores_that_are_left(shown):
    (matcher,) = [node for node in shown["nodes"] if node["cluster"] == 3]
    assert matcher["name"].strip("/") == "ndt_scan_matcher"
    assert len(matcher["workers"]) == MATCHER_CORES
    used = {matcher["core"], *(worker["core"] for worker in matcher["workers"])}
    assert len(used) == CORES - RESERVED_CORES - SPARE_CORES


def test_clusters_4_and_5_are_free(shown):
    assert {node["cluster"] for node in shown["nodes"]} == {2, 3}
