# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The picture: nothing overlaps, names are escaped, numbers are short."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from itertools import combinations

import pytest

from rmw_manycore_py.picture.drawing import draw
from rmw_manycore_py.picture.geometry import Rect
from rmw_manycore_py.picture.layout import Layout, lay_out
from rmw_manycore_py.picture.marks import changed, level
from rmw_manycore_py.picture.plan import MAX_NODES_OF_CELL
from rmw_manycore_py.picture.texts import bytes_text, fitted, rate_text, time_text
from rmw_manycore_py.platform.monitor.graph import Member
from support.samples.mappings import apart, graph, inside, member

pytestmark = pytest.mark.unit


def check(layout: Layout) -> None:
    width, height = layout.size
    for cluster in layout.clusters:
        assert inside(cluster.rect, Rect(0, 0, width, height))
        for rect in cluster.free.values():
            assert inside(rect, cluster.rect)
            assert all(apart(rect, cell.rect) for cell in cluster.cells)
        for cell in cluster.cells:
            assert inside(cell.rect, cluster.rect)
            assert all(inside(node.rect, cell.rect) for node in cell.nodes)
            assert all(apart(a.rect, b.rect) for a, b in combinations(cell.nodes, 2))
        assert all(apart(a.rect, b.rect) for a, b in combinations(cluster.cells, 2))
    assert all(apart(a.rect, b.rect) for a, b in combinations(layout.clusters, 2))


FEW = [member(0, 1, 1, "/talker"), member(1, 2, 1, "/a", "/b"), member(2, 2, None, "/c")]
CROWD = [member(i, i % 5 + 1, None, f"/n{i}") for i in range(500)]
FULL = [member(0, 1, 1, *(f"/n{i}" for i in range(40)))]


@pytest.mark.parametrize("members", [[], FEW, CROWD, FULL], ids=["none", "few", "crowd", "full"])
def test_nothing_overlaps(members: list[Member]) -> None:
    check(lay_out(graph(members), [1], dead=[member(900, 3, 15, "/dead")], workers={100: (1, 2)}))


def test_every_core_and_node_has_its_place() -> None:
    layout = lay_out(graph(FEW), [1, 2], dead=[member(9, 1, 1, "/dead")])
    assert {node.name: node.is_dead for node in layout.nodes} == {
        **dict.fromkeys(("/talker", "/a", "/b", "/c"), False),
        "/dead": True,
    }
    assert [cluster.is_used for cluster in layout.clusters] == [True, True, False, False, False]
    used = sum(cell.plan.core is not None for cell in layout.cells)
    assert used + sum(len(cluster.free) for cluster in layout.clusters) == 2 * 16
    (cell,) = [cell for cell in lay_out(graph(FULL), []).cells if cell.nodes]
    assert (len(cell.nodes), cell.hidden) == (MAX_NODES_OF_CELL, 40 - MAX_NODES_OF_CELL)


def test_workers_are_named() -> None:
    drawn = draw("p", lay_out(graph(FEW), [1, 2], workers={100: (70, 71)}), {})
    titles = [element.text for element in ElementTree.fromstring(drawn).iter() if element.text]
    assert {"NDT worker, pid 70", "NDT worker, pid 71"} <= set(titles)


def test_names_cannot_break_out() -> None:
    evil = '/a"><script>alert(1)</script>\x01'
    shown = graph([member(0, 1, 1, evil)], [("publisher", evil, 0), ("subscription", evil, 0)])
    layout = lay_out(shown, [1])
    root = ElementTree.fromstring(draw(evil, layout, {}))
    assert not [element for element in root.iter() if "script" in element.tag]
    assert any("<script>" in (element.get("data-node") or "") for element in root.iter())


def test_only_what_changed_is_sent() -> None:
    before = {"a": {"class": "x"}, "b": {"text": "1"}}
    assert changed(before, {"a": {"class": "x"}, "b": {"text": "2"}}) == {"b": {"text": "2"}}


def test_numbers_are_short() -> None:
    assert [rate_text(rate) for rate in (0, 0.5, 9.96, 99.4, 99.6, 250, 1500)] == [
        *("0 Hz", "0.5 Hz", "10 Hz", "99 Hz", "100 Hz", "250 Hz", "1.5 kHz")
    ]
    assert [bytes_text(size) for size in (0, 999, 1 << 21)] == ["0 B", "999 B", "2 MiB"]
    assert [time_text(us) for us in (8.4, 1500, 2e6)] == ["8.4 us", "1.5 ms", "2 s"]
    assert [level(share, 9) for share in (0, 0.01, 0.5, 1.0, 3.0)] == [0, 1, 5, 9, 9]
    assert fitted("/long/namespace/node", 50) == "…node"
    assert fitted("/talker", 100) == "/talker"
