# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Clusters that are proposed by communication."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.mapfile import check, init
from rmw_manycore_py.mapfile.communication import by_communication, talk_of
from support.samples.node_source import node_source

pytestmark = pytest.mark.unit


def proposed(
    pairs: dict[str, float], room: tuple[int, ...], nodes: str = "abcdefgh"
) -> dict[str, int]:
    """Return the clusters of nodes of one letter; a pair of letters exchanges messages."""
    talk = talk_of(
        ((pair[0], pair, weight) for pair, weight in pairs.items()),
        ((pair[1], pair) for pair in pairs),
    )
    return by_communication(nodes, talk, dict(enumerate(room, start=1)))


def test_nodes_without_topics_fill_one_cluster_after_the_other() -> None:
    assert [*proposed({}, (3, 3, 3)).values()] == [1, 1, 1, 2, 2, 2, 3, 3]


def test_a_group_goes_where_all_of_it_fits() -> None:
    clusters = proposed({"ab": 1, "cd": 1, "de": 1, "fg": 1}, (3, 4, 4))
    assert {name for name, cluster in clusters.items() if cluster == 2} == {"c", "d", "e"}
    assert clusters["a"] == clusters["b"] == 1
    assert clusters["f"] == clusters["g"] == 3


def test_a_group_too_large_for_any_cluster_is_cut_at_its_weakest_link() -> None:
    chain = {"ab": 10.0, "bc": 10.0, "cd": 1.0, "de": 10.0, "ef": 10.0}
    clusters = proposed(chain, (3, 3), "abcdef")
    assert clusters == {"a": 1, "b": 1, "c": 1, "d": 2, "e": 2, "f": 2}


def test_messages_to_oneself_bind_nothing() -> None:
    assert proposed({"aa": 5.0}, (1, 1), "ab") == {"a": 1, "b": 2}


def test_nodes_without_room_get_no_cluster() -> None:
    assert proposed({"ab": 1.0, "bc": 9.0}, (2,), "abcd") == {"a": 1, "b": 1}


def test_a_template_keeps_nodes_of_a_topic_together(tmp_path: Path) -> None:
    """Ten talkers and their listeners: a cluster has room for seven pairs."""
    for number in range(10):
        for kind, role in (("publisher", "talker"), ("subscription", "listener")):
            file = tmp_path / f"{role}{number}.py"
            source = node_source(f"{role}{number}", kind, topic=f'"/t{number}"')
            file.write_text(source + "main()\n")
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(init([tmp_path], tmp_path))
    clusters = {node.name: node.cluster for node in check(mapfile).nodes}
    assert all(clusters[f"talker{n}"] == clusters[f"listener{n}"] for n in range(10))
    assert sorted(clusters.values()) == [1] * 14 + [2] * 6
