# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The mapfile of the Autoware reference system matches its authors' description."""

from __future__ import annotations

import pytest

from rmw_manycore_py.create.figure import PAPERS_REDUCTION, by_hand, dot_of
from rmw_manycore_py.mapfile import PlacedNode, check
from support import MAPFILES
from support.samples import reference_system as described

pytestmark = pytest.mark.unit

MAPFILE = MAPFILES / "autoware_reference.yaml"
MESSAGE = "manycore_reference_msgs/msg/Message4kb"


@pytest.fixture(scope="module")
def nodes() -> dict[str, PlacedNode]:
    return {node.name: node for node in check(MAPFILE).nodes}


def test_each_of_24_nodes_has_a_core_of_its_own(nodes: dict[str, PlacedNode]) -> None:
    assert len(nodes) == 24
    assert len({node.place for node in nodes.values()}) == 24


def test_the_topic_table_has_the_graph(nodes: dict[str, PlacedNode]) -> None:
    listed = {(node.name, topic.strip("/")) for node in nodes.values() for topic in node.subscribe}
    published = {(node.name, topic.strip("/")) for node in nodes.values() for topic in node.publish}
    assert listed == described.subscriptions()
    assert published == described.publishers()
    types = {kind for n in nodes.values() for kind in (*n.publish.values(), *n.subscribe.values())}
    assert types == {MESSAGE}


def test_the_parameters_say_the_same(nodes: dict[str, PlacedNode]) -> None:
    """The order of inputs matters: outputs of an intersection follow it, and merged records."""
    periods = {
        name: node.parameters["period_ms"]
        for name, node in nodes.items()
        if "period_ms" in node.parameters
    }
    assert periods == {**described.SENSORS, described.CYCLIC: described.CYCLE_MS}
    for name, node in nodes.items():
        assert set(node.parameters.get("inputs", ())) == {
            topic.strip("/") for topic in node.subscribe
        }, name
        assert node.parameters["message"] == MESSAGE
    assert tuple(nodes[described.CYCLIC].parameters["inputs"]) == described.CYCLIC_INPUTS
    intersection = nodes[described.INTERSECTION].parameters
    assert dict(zip(intersection["inputs"], intersection["outputs"], strict=True)) == (
        described.CONNECTIONS
    )


def test_kinds(nodes: dict[str, PlacedNode]) -> None:
    kinds = {
        **dict.fromkeys(described.SENSORS, "sensor"),
        **dict.fromkeys(described.TRANSFORMS, "transform"),
        **dict.fromkeys(described.FUSIONS, "fusion"),
        described.CYCLIC: "cyclic",
        described.INTERSECTION: "intersection",
        **dict.fromkeys(described.COMMANDS, "command"),
    }
    assert {name: node.parameters["kind"] for name, node in nodes.items()} == kinds


def test_messages_a_second(nodes: dict[str, PlacedNode]) -> None:
    """The case study states 285 publications, 338 deliveries and 190 callbacks that work."""
    rates_hz = described.rates_hz()
    delivered_hz = sum(
        rates_hz[topic.strip("/")] for node in nodes.values() for topic in node.subscribe
    )
    assert sum(rates_hz.values()) == pytest.approx(285)
    assert delivered_hz == pytest.approx(338, abs=1)
    assert sum(rates_hz.values()) - sum(rates_hz[s] for s in described.SENSORS) == (
        pytest.approx(190)
    )


def test_it_saves_as_many_lines_as_the_paper_reports() -> None:
    dot = dot_of(MAPFILE)
    assert dot.nodes == 24
    assert dot.reduction >= PAPERS_REDUCTION


def test_the_papers_line() -> None:
    """Each further node of 15 parameters and 15 topics is 115 lines."""
    assert by_hand()[0] == 0
    assert {after - before for before, after in zip(by_hand(), by_hand()[1:], strict=False)} == {
        115
    }
