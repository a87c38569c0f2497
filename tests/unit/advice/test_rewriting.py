# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mapfiles with other places: the rest of the text stays."""

from __future__ import annotations

import pytest
import yaml

from rmw_manycore_py.advice.places import Place
from rmw_manycore_py.advice.rewriting import rewritten
from rmw_manycore_py.process.scheduling import Scheduling

pytestmark = pytest.mark.unit

FIFO = Scheduling("fifo", 12)


def test_a_value_is_replaced_and_comments_stay() -> None:
    text = (
        "# head\nplatform: coolidge\nnodes:\n  talker:  # talks\n    cluster: 1  # choose\n"
        "    script: a.py  # its file\n  listener: {cluster: 2, script: b.py}  # listens\n"
    )
    changed = rewritten(text, {"talker": Place(3), "listener": Place(4)})
    assert changed == text.replace("cluster: 1", "cluster: 3").replace("cluster: 2", "cluster: 4")


def test_new_keys_follow_the_cluster() -> None:
    text = (
        "nodes:\n  a:\n    cluster: 1  # here\n    script: a.py\n  b: {cluster: 1, script: b.py}\n"
    )
    places = {"a": Place(2, 5, 1, FIFO), "b": Place(1, 3)}
    assert rewritten(text, places) == (
        "nodes:\n  a:\n    cluster: 2  # here\n    core: 5\n    host_cpu: 1\n"
        "    scheduling: {policy: fifo, priority: 12}\n    script: a.py\n"
        "  b: {cluster: 1, core: 3, script: b.py}\n"
    )


def test_old_keys_are_replaced() -> None:
    text = (
        "nodes:\n  a:\n    core: 1\n    scheduling:\n      policy: other\n    cluster: 1\n"
        "  b: {core: 2, cluster: 2, scheduling: {policy: rr, priority: 3}}\n"
    )
    changed = yaml.safe_load(rewritten(text, {"a": Place(2, 5, None, FIFO), "b": Place(1, 7)}))
    fifo = {"policy": "fifo", "priority": 12}
    assert changed["nodes"] == {
        "a": {"core": 5, "cluster": 2, "scheduling": fifo},
        "b": {"core": 7, "cluster": 1, "scheduling": {"policy": "rr", "priority": 3}},
    }


def test_nodes_that_inherit_have_keys_of_their_own() -> None:
    text = (
        "nodes:\n  a: &node {cluster: 1, module: m}\n  b: {<<: *node}\n"
        "  c: {<<: *node, cluster: 2}\n  d: *node\n  e:\n    <<: *node\n    wait: spin\n"
    )
    places = {"a": Place(3, 1, 0, FIFO), "b": Place(1), "c": Place(2), "d": Place(4), "e": Place(5)}
    nodes = yaml.safe_load(rewritten(text, places))["nodes"]
    assert {name: node["cluster"] for name, node in nodes.items()} == {
        "a": 3, "b": 1, "c": 2, "d": 4, "e": 5,
    }  # fmt: skip
    assert {name for name, node in nodes.items() if node.get("scheduling")} == {"a"}
    assert {name for name, node in nodes.items() if node.get("host_cpu") is not None} == {"a"}
    assert all(node["module"] == "m" for node in nodes.values())


def test_a_list_of_ros_lite() -> None:
    text = "- name: a\n  cluster: 1  # here\n- {name: b, cluster: 2, core: 3}\n"
    assert rewritten(text, {"a": Place(5, 1), "b": Place(2, 4)}) == (
        "- name: a\n  cluster: 5  # here\n  core: 1\n- {name: b, cluster: 2, core: 4}\n"
    )


def test_the_end_of_a_file_without_a_line_break() -> None:
    assert rewritten("nodes:\n  a:\n    cluster: 1", {"a": Place(2, 3)}) == (
        "nodes:\n  a:\n    cluster: 2\n    core: 3"
    )
