# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Clusters with too much in them: one problem for each, and moves after which all fits."""

from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any

import pytest
import yaml
from click.testing import CliRunner

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.errors import EXIT_BAD_INPUT, EXIT_FAILURE
from rmw_manycore_py.mapfile import check
from rmw_manycore_py.mapfile.placing.moves import RoomError

pytestmark = pytest.mark.unit

NODE = "from rclpy.node import Node\nclass Quiet(Node):\n    pass\n"
TEXT = "std_msgs/msg/String"
CASES = 60


def write(directory: Path, data: dict[str, Any]) -> Path:
    (directory / "quiet.py").write_text(NODE)
    path = directory / "map.yaml"
    path.write_text(yaml.safe_dump(data, sort_keys=False))
    return path


def node(cluster: int, *publish: str, **more: Any) -> dict[str, Any]:
    topics = {"publish": dict.fromkeys(publish, TEXT)} if publish else {}
    return {"cluster": cluster, "script": "quiet.py", **topics, **more}


def mapfile(nodes: dict[str, Any], **topics: str) -> dict[str, Any]:
    sizes = {f"/{name}": {"type": TEXT, "topic_dsm_size": size} for name, size in topics.items()}
    return {"platform": "coolidge", "topics": sizes, "nodes": nodes}


def moved(data: dict[str, Any], moves: dict[str, int]) -> dict[str, Any]:
    """Return the mapfile after applying the advice."""
    nodes = {
        name: {k: v for k, v in one.items() if name not in moves or k not in ("cluster", "core")}
        for name, one in data["nodes"].items()
    }
    for name, cluster in moves.items():
        nodes[name]["cluster"] = cluster
    return {**data, "nodes": nodes}


def refused(directory: Path, data: dict[str, Any]) -> RoomError:
    with pytest.raises(RoomError) as caught:
        check(write(directory, data))
    return caught.value


def test_a_cluster_with_too_much_is_one_problem(tmp_path: Path) -> None:
    data = mapfile({f"n{i}": node(1, "/big") for i in range(40)}, big="240000")
    error = refused(tmp_path, data)
    problem, room, advice = str(error).splitlines()
    assert problem == (
        f"{tmp_path}/map.yaml:{problem.split(':')[1]}: nodes.n14: expected at most 14 nodes and "
        "3.5 MiB of topic DSMs in cluster 1, found 40 nodes and 9.155 MiB (/big 9.155 MiB)"
    )
    assert room == "room is left in clusters 2 to 5 (14 cores, 3.5 MiB each)"
    assert advice.startswith("it fits if you move n30, n31, ")
    assert check(write(tmp_path, moved(data, dict(error.advice.moves))))


def test_the_largest_nodes_leave_a_cluster_without_memory(tmp_path: Path) -> None:
    nodes = {"small": node(1, "/a", core=1), "large": node(1, "/b", core=2), "c": node(2, "/a")}
    data = mapfile(nodes, a="1MiB", b="3MiB")
    error = refused(tmp_path, data)
    assert str(error).splitlines()[1:] == [
        "room is left in cluster 2 (13 cores, 2.397 MiB) and clusters 3 to 5 "
        "(14 cores, 3.5 MiB each)",
        "it fits if you move large to cluster 3, without its core",
    ]
    assert check(write(tmp_path, moved(data, {"large": 3})))


def test_a_node_goes_to_those_it_shares_topics_with(tmp_path: Path) -> None:
    nodes = {f"n{i}": node(1) for i in range(14)}
    nodes |= {"last": node(1, "/a"), "partner": node(4, subscribe={"/a": TEXT})}
    assert refused(tmp_path, mapfile(nodes)).advice.moves == {"last": 4}


def test_workers_move_with_their_node(tmp_path: Path) -> None:
    data = mapfile({"a": node(1, workers=10), "b": node(1, workers=10), "c": node(2, workers=3)})
    error = refused(tmp_path, data)
    assert "at most 2, the cores that are left in cluster 1" in str(error)
    assert error.advice.moves == {"b": 3}
    assert check(write(tmp_path, moved(data, {"b": 3})))


def test_where_nothing_fits_other_cures_are_named(tmp_path: Path) -> None:
    data = mapfile({f"n{i}": node(1 + i % 5, "/a") for i in range(10)}, a="3MiB")
    lines = str(refused(tmp_path, data)).splitlines()
    assert len(lines) == 5 + 2
    assert lines[5:] == [
        "no cluster has room",
        "no way to move nodes was found: lower topic_dsm_size, or take a larger platform",
    ]


def test_where_no_core_is_left_nodes_may_share_one(tmp_path: Path) -> None:
    data = mapfile({f"n{i}": node(1 + i % 5) for i in range(80)})
    assert str(refused(tmp_path, data)).splitlines()[-1] == (
        "no way to move nodes was found: let nodes share a core (core, allow_shared_cores), "
        "or take a larger platform"
    )


def test_a_mapfile_that_follows_the_advice_is_valid(tmp_path: Path) -> None:
    """Also with transferred topics, whose landings move with publishers and subscribers."""
    followed = 0
    for seed in range(CASES):
        data = made(random.Random(seed))
        try:
            check(write(tmp_path, data))
        except RoomError as error:
            if error.advice.moves:
                check(write(tmp_path, moved(data, dict(error.advice.moves))))
                followed += 1
    assert followed > CASES / 3


def made(chosen: random.Random) -> dict[str, Any]:
    names = [f"t{i}" for i in range(6)]
    data = mapfile({}, **{name: f"{chosen.randint(1, 900)}KiB" for name in names})
    for topic in data["topics"].values():
        topic["transfer"] = chosen.choice(["dsm", "dsm", "async", "message"])
    for i in range(chosen.randint(5, 50)):
        publish = [f"/{name}" for name in chosen.sample(names, chosen.choice((0, 0, 1)))]
        subscribe = {f"/{name}": TEXT for name in chosen.sample(names, chosen.choice((0, 1)))}
        workers = chosen.choice((0, 0, 0, 2))
        place = node(chosen.choice((1, 1, 1, 2)), *publish, workers=workers, subscribe=subscribe)
        data["nodes"][f"n{i}"] = place
    return data


def test_json_has_the_moves(tmp_path: Path) -> None:
    path = write(tmp_path, mapfile({f"n{i}": node(1) for i in range(15)}))
    result = CliRunner().invoke(cli, ["map", "check", str(path), "--json"])
    assert result.exit_code == EXIT_BAD_INPUT
    data = json.loads(result.stdout)
    assert not data["valid"]
    assert data["problems"][0]["found"] == "15 nodes"
    assert data["moves"] == {"n14": 2}
    assert data["room"][0] == {"cluster": 2, "cores": 14, "size_bytes": 3670016}


@pytest.mark.parametrize(("nodes", "status"), [(7, 0), (9, 0), (11, EXIT_FAILURE)])
def test_nodes_take_memory_too(nodes: int, status: int, tmp_path: Path) -> None:
    """They may start with 9 nodes of 100 KiB in 1 MiB, if those with rings come first."""
    data = mapfile({f"n{i}": node(1) for i in range(nodes)})
    data["platform"] = {"profile": "coolidge", "smem_size": "1MiB"}
    path = write(tmp_path, data)
    result = CliRunner().invoke(cli, ["map", "check", str(path)])
    assert result.exit_code == status, result.output
    words = {7: "it fits, ", 9: "it may not fit, ", 11: "it does not fit, "}
    assert f"verdict: {words[nodes]}cluster 1 " in result.output
    answer = json.loads(CliRunner().invoke(cli, ["map", "check", str(path), "--json"]).stdout)
    assert ("moves" in answer) == (nodes > 7)
    if nodes > 7:
        again = write(tmp_path, moved(data, answer["moves"]))
        assert "verdict: it fits, " in CliRunner().invoke(cli, ["map", "check", str(again)]).output
