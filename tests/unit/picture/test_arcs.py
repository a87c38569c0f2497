# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Lines of topics: they join their cells, run around all others, and their labels cover nothing."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, pairwise

import pytest

from rmw_manycore_py.picture.arcs import LOAD_LENGTH, MAX_LABELS, Arc
from rmw_manycore_py.picture.geometry import Rect, head_of, path_of
from rmw_manycore_py.picture.layout import Layout, lay_out
from rmw_manycore_py.picture.marks import label_text
from rmw_manycore_py.picture.texts import BOLD, SMALL, fitted, width_of
from rmw_manycore_py.picture.wires import MAX_PAIRS
from rmw_manycore_py.platform.monitor.graph import Graph
from rmw_manycore_py.platform.monitor.latency import TopicLatency
from rmw_manycore_py.platform.monitor.loads import TopicLoad
from support.samples.mappings import apart, graph, inside, mapping, member

pytestmark = pytest.mark.unit

MAPPINGS = [(seed, nodes) for seed, nodes in enumerate([2, 3, 6, 6, 12, 25, 40, 40, 120])]
FEW = [member(0, 1, 1, "/talker"), member(1, 2, 1, "/a"), member(2, 2, None, "/c")]


@pytest.fixture(scope="module", params=MAPPINGS, ids=lambda one: f"{one[1]}-nodes-{one[0]}")
def layout(request: pytest.FixtureRequest) -> Layout:
    return lay_out(mapping(*request.param), [])


def pieces(arc: Arc) -> Iterator[Rect]:
    """Yield each straight piece of an arc, as a rectangle without an area."""
    for line in arc.lines:
        for (x0, y0), (x1, y1) in pairwise(line):
            assert x0 == x1 or y0 == y1
            yield Rect(min(x0, x1), min(y0, y1), abs(x1 - x0), abs(y1 - y0))


def is_cut(rect: Rect, piece: Rect) -> bool:
    return (
        piece.right > rect.x
        and piece.x < rect.right
        and piece.bottom > rect.y
        and piece.y < rect.bottom
    )


def names_of(layout: Layout) -> list[Rect]:
    """Return what has a name or a figure: heads of clusters, cells, free cores."""
    heads = [
        Rect(c.rect.x, c.rect.y, c.rect.width, c.receive_thread.bottom - c.rect.y)
        for c in layout.clusters
        if c.is_used
    ]
    idle = [cluster.rect for cluster in layout.clusters if not cluster.is_used]
    free = [tile for cluster in layout.clusters for tile in cluster.free.values()]
    return [*heads, *idle, *free, *(cell.rect for cell in layout.cells)]


def test_lines_run_around_cells_and_names(layout: Layout) -> None:
    names = names_of(layout)
    for arc in layout.arcs:
        for piece in pieces(arc):
            assert inside(piece, Rect(0, 0, *layout.size))
            assert not [rect for rect in names if is_cut(rect, piece)], arc.id


def test_lines_join_the_cells_of_their_nodes(layout: Layout) -> None:
    cells = {cell.id: cell.rect for cell in layout.cells}
    for arc in layout.arcs:
        for pair, line in zip(arc.wire.pairs, arc.lines, strict=True):
            for cell, (x, y) in zip(pair, (line[0], line[-1]), strict=True):
                assert cells[cell].x < x < cells[cell].right
                assert y in (cells[cell].y, cells[cell].bottom)


def test_labels_cover_neither_each_other_nor_a_name(layout: Layout) -> None:
    labels = [arc.label for arc in layout.arcs if arc.label is not None]
    assert len(labels) == min(len(layout.arcs), MAX_LABELS)
    assert all(apart(one, other) for one, other in combinations(labels, 2))
    names = names_of(layout)
    for label in labels:
        assert inside(label, Rect(0, 0, *layout.size))
        assert all(apart(label, name) for name in names)


def test_labels_are_on_their_lines_and_no_other_runs_along(layout: Layout) -> None:
    for arc in layout.arcs:
        label = arc.label
        if label is None:
            continue
        middle = label.centre[1]
        near = (p for p in pieces(arc) if p.y == pytest.approx(middle))
        assert any(p.x <= label.right and p.right >= label.x for p in near)
        along = (p for other in layout.arcs if other is not arc for p in pieces(other) if p.width)
        assert not [piece for piece in along if is_cut(label, piece)]


def test_labels_have_room_for_their_texts(layout: Layout) -> None:
    load = TopicLoad(1234.5, 9.9e9, 99, 100, 123456, 0, 1.0)
    latency = TopicLatency(1, 999_000.0, 999_000.0)
    text = label_text(load, latency)
    assert "123456 lost" in text
    assert len(text) <= LOAD_LENGTH
    for arc in layout.arcs:
        if arc.label is not None:
            assert width_of(fitted(arc.name, arc.label.width, BOLD), BOLD) <= arc.label.width
            assert width_of(text, SMALL) <= arc.label.width


def test_topics_between_the_same_cells_are_one_line() -> None:
    ends = [(kind, f"/t{n}", n % 2) for n in range(4) for kind in ("publisher",)]
    ends += [("subscription", f"/t{n}", 1 - n % 2) for n in range(4)]
    arcs = lay_out(graph(FEW, ends), []).arcs
    assert [arc.wire.topics for arc in arcs] == [("/t0", "/t2"), ("/t1", "/t3")]
    assert [arc.name for arc in arcs] == ["/t0 +1", "/t1 +1"]


def pipelines(count: int, clusters: int = 1) -> Graph:
    """Return pipelines of a camera and a filter; each in a cluster of its own, if there are."""
    names = [name for n in range(count) for name in (f"/arm2/cam{n}", f"/arm2/filter{n}")]
    members = [member(n, n // 2 % clusters + 1, n, name) for n, name in enumerate(names)]
    ends = [
        (kind, f"/arm2/cam{n // 2}/{topic}", n)
        for n in range(2 * count)
        for topic in ("image", "info")
        for kind in (("subscription",) if n % 2 else ("publisher",))
    ]
    return graph(members, ends)


def test_parallel_pipelines_are_one_line_of_all_their_pairs() -> None:
    (arc,) = lay_out(pipelines(4), []).arcs
    assert arc.name == "4 x /arm2/cam*/image +1"
    assert len(arc.wire.topics) == 8
    assert arc.wire.nodes_of["/arm2/cam3/info"] == ("/arm2/cam3", "/arm2/filter3")
    assert sorted(arc.wire.pairs) == [(f"c1-{n}", f"c1-{n + 1}") for n in (0, 2, 4, 6)]


def test_few_pipelines_and_those_of_other_clusters_stay_apart() -> None:
    assert len(lay_out(pipelines(2), []).arcs) == 2
    assert len(lay_out(pipelines(4, clusters=4), []).arcs) == 4


def test_stages_of_one_pipeline_stay_apart() -> None:
    members = [member(n, 1, n, f"/stage{n}") for n in range(5)]
    ends = [
        (kind, f"/t{n}", n + offset)
        for n in range(4)
        for offset, kind in enumerate(("publisher", "subscription"))
    ]
    assert len(lay_out(graph(members, ends), []).arcs) == 4


def test_lines_go_from_publishers_to_subscriptions_of_drawn_topics() -> None:
    ends = [("publisher", "/t", 0), ("subscription", "/t", 1)]
    ends += [("publisher", "/rosout", 0), ("subscription", "/rosout", 1)]
    ends += [("publisher", "/unheard", 0)]
    layout = lay_out(graph(FEW, ends), [])
    (arc,) = layout.arcs
    assert arc.wire.nodes_of == {"/t": ("/a", "/talker")}
    assert arc.wire.pairs == (("c1-1", "c2-1"),)


def test_many_ends_are_joined_by_few_lines() -> None:
    crowd = [member(slot, slot % 5 + 1, None, f"/n{slot}") for slot in range(20)]
    ends = [("publisher", "/t", slot) for slot in range(3)]
    ends += [("subscription", "/t", slot) for slot in range(3, 3 + MAX_PAIRS)]
    (arc,) = lay_out(graph(crowd, ends), []).arcs
    assert len(arc.lines) == 3 + MAX_PAIRS - 1


def test_arrowheads_point_along_the_last_piece() -> None:
    assert head_of(((0, 0), (0, 20))) == "M0.0 20.0L4.0 12.0L-4.0 12.0Z"
    assert path_of(((0, 0), (0, 20), (4, 20))) == "M0.0 0.0L0.0 15.0Q0.0 20.0 2.0 20.0L4.0 20.0"
