# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile import Placement, as_data, check
from rmw_manycore_py.mapfile.placing.parameter_values import parameter_text
from rmw_manycore_py.mapfile.placing.sessions import MAX_SESSIONS
from rmw_manycore_py.platform.topology import Core
from rmw_manycore_py.ros.names import resolve_topic
from support.samples.node_source import node_source

pytestmark = pytest.mark.unit

Check = Callable[[str], Placement]
CPU = min(os.sched_getaffinity(0))


@pytest.fixture
def resolved(tmp_path: Path) -> Check:
    (tmp_path / "talker.py").write_text(node_source())
    (tmp_path / "listener.py").write_text(node_source(kind="subscription"))

    def check_text(text: str) -> Placement:
        (tmp_path / "mapfile.yaml").write_text(text)
        return check(tmp_path / "mapfile.yaml")

    return check_text


def test_a_node_becomes_a_command_with_ros_arguments(resolved: Check, tmp_path: Path) -> None:
    (tmp_path / "p.yaml").write_text("/**: {ros__parameters: {a: 1}}")
    (node,) = resolved(
        "nodes:\n  talker:\n    cluster: 1\n    script: talker.py\n    namespace: demo\n"
        "    arguments: [--loud]\n    param_file: p.yaml\n"
        "    remappings: {chatter: /news}\n    parameters: {rate_hz: 10, name: '10'}\n"
    ).nodes
    assert node.argv == [
        *(sys.executable, str(tmp_path / "talker.py"), "--loud", "--ros-args"),
        *("-r", "__node:=talker", "-r", "__ns:=/demo", "-r", "chatter:=/news"),
        *("--params-file", str(tmp_path / "p.yaml")),
        *("-p", "rate_hz:=10", "-p", 'name:="10"'),
    ]
    assert (node.full_name, node.cwd) == ("/demo/talker", tmp_path)


def test_a_node_gets_its_place(resolved: Check) -> None:
    (node,) = resolved(
        "platform: {profile: coolidge, name: chip}\n"
        "nodes:\n  t: {cluster: 3, core: 4, script: talker.py, wait: adaptive, env: {DEPTH: 2}}\n"
    ).nodes
    assert node.env == {
        "RMW_IMPLEMENTATION": "rmw_manycore",
        "MANYCORE_PLATFORM": "chip",
        "MANYCORE_CLUSTER": "3",
        "MANYCORE_CORE": "4",
        "MANYCORE_WAIT": "adaptive",
        "PYTHONUNBUFFERED": "1",
        "MALLOC_TRIM_THRESHOLD_": str(1 << 30),
        "MALLOC_MMAP_THRESHOLD_": str(1 << 30),
        "DEPTH": "2",
    }


def test_a_node_of_another_domain_is_not_on_the_platform(
    resolved: Check, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    text = (
        "platform: {name: chip}\nnodes:\n"
        "  a: {cluster: 1, script: talker.py, env: {ROS_DOMAIN_ID: 7}}\n"
        "  b: {cluster: 1, script: talker.py, env: {ROS_DOMAIN_ID: 8}}\n"
    )
    placement = resolved(text)
    assert [node.env["MANYCORE_PLATFORM"] for node in placement.nodes] == ["chip", ""]
    assert [node.env["MANYCORE_CLUSTER"] for node in placement.nodes] == ["1", ""]
    (notice,) = [text for text in placement.notices if "ROS_DOMAIN_ID" in text]
    assert notice == (
        "'b' has ROS_DOMAIN_ID=8: it meets the nodes of that domain, and none of platform 'chip'"
    )


def test_malloc_tuning_can_be_switched_off(resolved: Check) -> None:
    text = "malloc_tuning: false\nnodes:\n  t: {cluster: 1, script: talker.py}\n"
    assert not [key for key in resolved(text).nodes[0].env if key.startswith("MALLOC")]


def test_the_platform_is_that_of_nodes_started_by_hand(
    resolved: Check, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("MANYCORE_PLATFORM", raising=False)
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    assert resolved("nodes:\n  t: {cluster: 1, script: talker.py}\n").name == "domain-7"


def test_nodes_without_a_core_take_the_first_free_ones(resolved: Check) -> None:
    placement = resolved(
        "nodes:\n"
        "  a: {cluster: 1, script: talker.py}\n"
        "  b: {cluster: 1, core: 1, script: talker.py}\n"
        "  c: {cluster: 1, script: talker.py}\n"
    )
    assert [node.core for node in placement.nodes] == [2, 1, 3]


def test_nodes_get_host_cpus_before_receive_threads(resolved: Check) -> None:
    cpus = sorted(os.sched_getaffinity(0))
    placement = resolved(
        f"nodes:\n  a: {{cluster: 2, script: talker.py, host_cpu: {cpus[-1]}}}\n"
        "  b: {cluster: 1, script: talker.py}\n"
    )
    assert list(placement.host_cpus) == [Core(2, 1), Core(1, 1), Core(1, 0), Core(2, 0)]
    assert placement.nodes[0].host_cpu == cpus[-1]
    assert placement.nodes[1].host_cpu == cpus[0]


def test_sources_fill_the_topic_table(resolved: Check) -> None:
    placement = resolved(
        "topics:\n  /late: {topic_dsm_size: 64KiB, type: std_msgs/msg/Int32}\n"
        "nodes:\n"
        "  talker: {cluster: 1, script: talker.py, remappings: {chatter: /news}}\n"
        "  one: {cluster: 3, script: listener.py, remappings: {chatter: /news}}\n"
        "  two: {cluster: 2, script: listener.py, remappings: {chatter: /news}}\n"
        "  other: {cluster: 2, script: listener.py, namespace: x}\n"
    )
    table = [(t.id, t.name, t.topic_dsm_size, t.receiver_clusters) for t in placement.topics]
    assert table == [
        (1, "/late", 65536, ()),
        (2, "/news", None, (2, 3)),
        (3, "/x/chatter", None, (2,)),
    ]
    assert placement.topics[1].publisher_clusters == (1,)
    assert placement.topics[1].receiver_mask == 0b110


def test_a_transferred_topic_takes_memory_in_each_receiving_cluster(resolved: Check) -> None:
    placement = resolved(
        "platform: coolidge\n"
        "topics: {chatter: {topic_dsm_size: 1MiB, transfer: message, priority: 7}}\n"
        "nodes:\n"
        "  a: {cluster: 1, script: talker.py}\n"
        "  b: {cluster: 2, script: talker.py}\n"
        "  c: {cluster: 2, script: listener.py}\n"
        "  d: {cluster: 3, script: listener.py}\n"
    )
    topic = placement.topics[0]
    assert (topic.transfer, topic.priority, topic.synchronous) == ("message", 7, False)
    assert [(node.name, cluster) for node, cluster in topic.landings] == [
        ("a", 2),
        ("a", 3),
        ("b", 3),
    ]
    assert [memory.used >> 20 for memory in placement.memory[:4]] == [1, 2, 2, 0]


def test_topics_say_how_large_messages_are_read(resolved: Check) -> None:
    placement = resolved(
        "topics: {chatter: {zero_copy: read_only}}\nnodes: {a: {cluster: 1, script: talker.py}}\n"
    )
    assert placement.topics[0].zero_copy == "read_only"


def test_sessions_of_a_cluster_are_limited(resolved: Check) -> None:
    text = (
        "platform: coolidge\n"
        "topics: {chatter: {topic_dsm_size: 64KiB, transfer: session}}\n"
        "nodes:\n"
        "  listener: {cluster: 2, script: listener.py}\n"
    )
    for number in range(MAX_SESSIONS):
        text += f"  talker{number}: {{cluster: 1, script: talker.py}}\n"
    assert len(resolved(text).topics[0].landings) == MAX_SESSIONS
    with pytest.raises(MapfileError, match="at most 8 sessions of cluster 1 to others"):
        resolved(text + "  talker: {cluster: 1, script: talker.py}\n")


def test_each_publisher_takes_a_ring_of_its_clusters_memory(resolved: Check) -> None:
    placement = resolved(
        "platform: coolidge\ntopics:\n  chatter: {topic_dsm_size: 1MiB}\n"
        "nodes:\n"
        "  a: {cluster: 1, script: talker.py}\n"
        "  b: {cluster: 1, script: talker.py}\n"
        "  c: {cluster: 2, script: talker.py}\n"
        "  d: {cluster: 3, script: listener.py}\n"
    )
    assert [memory.used for memory in placement.memory] == [2 << 20, 1 << 20, 0, 0, 0]


def test_the_bridge_takes_cores_that_no_node_uses(resolved: Check) -> None:
    bridge = resolved(
        "nodes:\n"
        "  talker: {cluster: 1, core: 2, script: talker.py, namespace: a,"
        " topic_to: {chatter: std_msgs/msg/String}}\n"
        "  listener: {cluster: 2, core: 1, script: listener.py,"
        " topic_in: {/goal: std_msgs/msg/String}}\n"
    ).bridge
    assert bridge is not None
    crossing = {route.inside: (route.direction, route.type) for route in bridge.routes}
    assert crossing == {
        "/goal": ("inward", "std_msgs/msg/String"),
        "/a/chatter": ("outward", "std_msgs/msg/String"),
    }
    assert bridge.cores == ((Core(1, 1), Core(1, 3)),)


@pytest.mark.parametrize(
    ("written", "found"),
    [
        ("{}", ()),
        ("{host_cpu: none}", ()),
        (f"{{host_cpu: {CPU}}}", (CPU,)),
        (f"{{host_cpu: [{CPU}, {CPU}]}}", (CPU,)),
    ],
)
def test_the_bridge_runs_on_the_cpus_that_are_named(resolved: Check, written, found) -> None:
    bridge = resolved(
        f"bridge: {written}\n"
        "nodes:\n"
        "  talker: {cluster: 1, script: talker.py, topic_to: {chatter: std_msgs/msg/String}}\n"
    ).bridge
    assert bridge is not None
    assert bridge.host_cpus == found


def test_the_bridge_takes_no_cpu_from_nodes(resolved: Check) -> None:
    placement = resolved(
        "nodes:\n"
        "  talker: {cluster: 1, script: talker.py, topic_to: {chatter: std_msgs/msg/String}}\n"
        "  listener: {cluster: 2, script: listener.py}\n"
    )
    assert placement.bridge is not None
    cores_of_bridge = {core for lane in placement.bridge.cores for core in lane}
    assert not cores_of_bridge & set(placement.host_cpus)
    assert {core for core in placement.host_cpus if core.core == 0} == {Core(1, 0), Core(2, 0)}


def test_parameters_have_a_route_by_the_name_of_their_node(resolved: Check) -> None:
    bridge = resolved(
        "bridge: {routes: {/a/talker: {name: /robot/talker, timeout: 2}}}\n"
        "nodes:\n"
        "  talker: {cluster: 1, script: talker.py, namespace: a, parameters_in: true}\n"
    ).bridge
    assert bridge is not None
    assert {route.outside.rpartition("/")[0] for route in bridge.routes} == {"/robot/talker"}
    assert {(route.kind, route.timeout_s) for route in bridge.routes} == {("service", 2.0)}


def test_the_mapfile_overrules_the_launch_file(resolved: Check, tmp_path: Path) -> None:
    (tmp_path / "p.yaml").write_text("talker: {ros__parameters: {a: 2, b: 2}}")
    (tmp_path / "demo.launch.xml").write_text(
        '<launch><node pkg="p" exec="e" name="talker" namespace="low">'
        '<param name="a" value="1"/><param name="c" value="1"/><param name="d" value="1"/>'
        '<remap from="chatter" to="/launch"/></node></launch>'
    )
    (node,) = resolved(
        "launch_path: demo.launch.xml\n"
        "nodes:\n  talker: {cluster: 1, script: talker.py, remappings: {chatter: /mapfile},"
        " param_file: p.yaml, namespace: /, parameters: {d: 3}}\n"
    ).nodes
    assert node.parameters == {"c": 1, "d": 3}
    assert list(node.publish) == ["/mapfile"]
    assert node.full_name == "/talker"


def test_a_launch_file_sets_any_variable_but_the_place(resolved: Check, tmp_path: Path) -> None:
    (tmp_path / "demo.launch.xml").write_text(
        '<launch><set_env name="MANYCORE_DIRECTORY" value="/tmp"/>'
        '<set_env name="MANYCORE_PLATFORM" value="other"/><set_env name="A" value="1"/>'
        '<node pkg="p" exec="e" name="talker"/></launch>'
    )
    (node,) = resolved(
        "platform: {name: mine}\nlaunch_path: demo.launch.xml\n"
        "nodes:\n  talker: {cluster: 1, script: talker.py}\n"
    ).nodes
    assert node.env["A"] == "1"
    assert node.env["MANYCORE_PLATFORM"] == "mine"
    assert "MANYCORE_DIRECTORY" not in node.env


def test_nodes_of_the_launch_file_that_are_not_placed_are_noted(
    resolved: Check, tmp_path: Path
) -> None:
    (tmp_path / "demo.launch.xml").write_text(
        '<launch>\n<node pkg="p" exec="talker"/>\n<node pkg="p" exec="driver"/>\n</launch>'
    )
    notices = resolved(
        "launch_path: demo.launch.xml\nnodes:\n  talker: {cluster: 1, script: talker.py}\n"
    ).notices
    expected = "demo.launch.xml:3: 'driver' is not in the mapfile and does not run here"
    assert any(notice.endswith(expected) for notice in notices)


def test_a_command_is_found_beside_the_interpreter(resolved: Check) -> None:
    (node,) = resolved(
        "nodes:\n  a: {cluster: 1, command: python3 talker.py, ros_arguments: false}\n"
    ).nodes
    assert Path(node.argv[0]).parent == Path(sys.executable).parent
    assert node.argv[1:] == ["talker.py"]
    assert list(node.publish) == ["/chatter"]


def test_an_executable_is_found_in_the_prefixes(
    resolved: Check, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    executable = tmp_path / "prefix/lib/demo/speak"
    executable.parent.mkdir(parents=True)
    executable.write_text("#!/usr/bin/env python3\n" + node_source())
    executable.chmod(0o755)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    text = "nodes:\n  a: {cluster: 1, package: demo, executable: speak}\n"
    (node,) = resolved(text).nodes
    assert node.argv[:2] == [sys.executable, str(executable)]
    executable.chmod(0o644)
    with pytest.raises(MapfileError, match=r"nodes.a.executable: expected an executable"):
        resolved(text)


def test_a_placement_is_plain_data(resolved: Check) -> None:
    data = as_data(resolved("nodes:\n  talker: {cluster: 1, script: talker.py}\n"))
    assert data["nodes"][0]["name"] == "talker"
    assert data["topics"][0]["receiver_clusters"] == []


@pytest.mark.parametrize(
    ("topic", "full"),
    [
        ("a", "/ns/a"),
        ("/a", "/a"),
        ("~/a", "/ns/node/a"),
        ("moved", "/ns/there"),
        ("mine", "/for/node"),
        ("not_mine", "/ns/not_mine"),
    ],
)
def test_topic_names_are_expanded_as_rcl_does(topic: str, full: str) -> None:
    rules = [
        ("__node", "node"),
        ("moved", "there"),
        ("moved", "second"),
        ("node:mine", "/for/node"),
        ("other:not_mine", "/x"),
    ]
    assert resolve_topic(topic, "/ns/node", rules) == full


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1, "1"),
        (1.0, "1.0"),
        (True, "true"),
        ("true", '"true"'),
        ("é 'x'", "\"é 'x'\""),
        (float("inf"), ".inf"),
        (float("nan"), ".nan"),
        ([1.5, 2.0], "[1.5, 2.0]"),
        (["a", "1"], '["a", "1"]'),
    ],
)
def test_parameters_keep_their_type(value: object, text: str) -> None:
    assert parameter_text(value) == text


def test_workers_get_the_next_free_cores_and_their_host_cpus(resolved: Check) -> None:
    text = "platform: {profile: coolidge}\nnodes:\n"
    text += "  talker: {cluster: 3, core: 2, script: talker.py, workers: 3}\n"
    text += "  listener: {cluster: 3, core: 3, script: listener.py, workers: 1}\n"
    talker, listener = resolved(text).nodes
    assert [core for core, _ in talker.workers] == [Core(3, 1), Core(3, 4), Core(3, 5)]
    assert [core for core, _ in listener.workers] == [Core(3, 6)]
    cpus = [str(cpu) for _, cpu in talker.workers]
    assert talker.env["MANYCORE_WORKER_CPUS"] == ",".join(cpus)


def test_more_workers_than_cores_are_an_error(resolved: Check) -> None:
    text = "platform: {profile: coolidge}\nnodes:\n"
    text += "  talker: {cluster: 3, core: 1, script: talker.py, workers: 14}\n"
    with pytest.raises(MapfileError, match="at most 13, the cores that are left in cluster 3"):
        resolved(text)
