# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`ros_lite.map` is the mapping that ROS-lite describes, compared with its sentences by number.

"Each node is allocated to one cluster using ROS-lite." "This demonstration parallelized derivatives
onto five CCs and radius_search onto two CCs, and the remainder of the algorithm was executed in
parallel on the IOC with its four cores." "The left of Fig. 16 shows the execution result before
parallelization, which denotes that all applications are running on the four cores on IOC."
"""

from __future__ import annotations

import json
from collections import Counter
from typing import Any

import pytest
from click.testing import CliRunner

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile import load_mapfile, resolve
from rmw_manycore_py.papers.roslite.variants import (
    AFTER,
    BEFORE,
    installed,
    with_split,
    with_transfer,
    write,
)
from support import MAPFILES

pytestmark = pytest.mark.unit

PLANNING = {"lane_rule", "lane_select", "waypoint_filter", "velocity_set"}
FOLLOWING = {"pure_pursuit", "twist_filter"}
COMPUTE_CLUSTERS, IO_CLUSTERS = range(1, 17), range(17, 21)


def shown(name: str) -> dict[str, Any]:
    result = CliRunner().invoke(cli, ["map", "show", str(MAPFILES / name), "--json"])
    assert result.exit_code == 0, result.output
    data: dict[str, Any] = json.loads(result.stdout)
    return data


def clusters(name: str) -> dict[str, int]:
    return {node["name"].strip("/"): node["cluster"] for node in shown(name)["nodes"]}


def test_each_node_of_planning_and_following_has_a_cluster_of_its_own():
    placed = clusters(AFTER)
    alone = {name for name, number in Counter(placed.values()).items() if number == 1}
    for name in PLANNING | FOLLOWING:
        assert placed[name] in COMPUTE_CLUSTERS
        assert placed[name] in alone


def test_the_localizer_has_five_and_two_clusters_and_the_io_cluster():
    placed = clusters(AFTER)
    of = {
        kind: {cluster for name, cluster in placed.items() if name.startswith(kind)}
        for kind in ("derivatives", "radius", "lidar_localizer")
    }
    assert len(of["derivatives"]) == 5
    assert len(of["radius"]) == 2
    assert of["derivatives"] | of["radius"] <= set(COMPUTE_CLUSTERS)
    assert of["lidar_localizer"] == {17}
    assert 17 in IO_CLUSTERS


def test_before_all_nodes_share_the_four_cores_of_an_io_cluster():
    nodes = shown(BEFORE)["nodes"]
    names = {node["name"].strip("/") for node in nodes}
    assert names == PLANNING | FOLLOWING | {"lidar_localizer"}
    assert {node["cluster"] for node in nodes} == {17}
    assert {node["core"] for node in nodes} == {0, 1, 2, 3}


def test_the_clusters_are_those_of_bostan():
    platform = shown(AFTER)["clusters"]
    assert [cluster["cores"] for cluster in platform] == [16] * 16 + [4] * 4
    assert {cluster["smem_size"] for cluster in platform} == {2 << 20}


@pytest.mark.parametrize("derivatives", [1, 3, 5])
@pytest.mark.parametrize("searches", [2, 3])
def test_another_split_has_its_own_number_of_clusters(tmp_path, derivatives, searches):
    variant = with_split(installed(AFTER), derivatives, searches)
    placement = resolve(load_mapfile(write(variant, tmp_path / "split.yaml")))
    placed = Counter(
        kind
        for node in placement.nodes
        for kind in ("derivatives", "radius")
        if node.name.strip("/").startswith(kind)
    )
    assert placed == {"derivatives": derivatives, "radius": searches}
    assert len({node.cluster for node in placement.nodes}) == len(placement.nodes)


def test_lanes_of_4000_waypoints_need_clusters_of_4_mib(tmp_path):
    long = with_transfer(installed(AFTER), ["/base_waypoints"], "session", 4000)
    path = write(long, tmp_path / "long.yaml")
    resolve(load_mapfile(path))
    with pytest.raises(MapfileError, match=r"topics\./lane_waypoints_array\.topic_dsm_size"):
        resolve(load_mapfile(write({**long, "platform": "bostan"}, path)))
    short = with_transfer(installed(AFTER), ["/base_waypoints"], "session", 1000)
    assert short["platform"] == "bostan"
    resolve(load_mapfile(write(short, path)))


def test_a_mapfile_that_needs_more_than_a_cluster_has_is_refused_by_name(tmp_path):
    """Table I leaves about 1 MB of 2 MB for topics: two rings of a megabyte are too many."""
    variant = installed(AFTER)
    variant["topics"] = {"/final_waypoints": {"topic_dsm_size": "2MiB"}}
    with pytest.raises(MapfileError, match=r"topics\./final_waypoints\.topic_dsm_size"):
        resolve(load_mapfile(write(variant, tmp_path / "large.yaml")))
    variant["topics"] = {
        topic: {"topic_dsm_size": "1MiB"} for topic in ("/base_waypoints", "/closest_waypoint")
    }
    with pytest.raises(MapfileError, match=r"at most 1\.75 MiB of topic DSMs in cluster 2"):
        resolve(load_mapfile(write(variant, tmp_path / "large.yaml")))
