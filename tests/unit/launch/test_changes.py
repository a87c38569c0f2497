# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a changed mapfile changes of what runs; the rest stays where it is."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from rmw_manycore_py.launch.changes import Changes
from rmw_manycore_py.mapfile import Mapfile, Placement, load_mapfile, resolve
from rmw_manycore_py.mapfile.placing.cores import FRESH, Kept

pytestmark = pytest.mark.unit

CPU = min(os.sched_getaffinity(0))
SLEEP = "command: [sleep, '1'], ros_arguments: false"
Read = Callable[..., tuple[Mapfile, Placement]]


@pytest.fixture
def read(tmp_path: Path) -> Read:
    def read_nodes(kept: Kept = FRESH, **nodes: str) -> tuple[Mapfile, Placement]:
        lines = [f"  {name}: {{{section}, {SLEEP}}}\n" for name, section in nodes.items()]
        (tmp_path / "map.yaml").write_text(f"nodes:\n{''.join(lines)}")
        mapfile = load_mapfile(tmp_path / "map.yaml")
        return mapfile, resolve(mapfile, kept=kept)

    return read_nodes


def changes(read: Read, before: dict[str, str], after: dict[str, str]) -> list[str]:
    mapfile, old = read(**before)
    _, new = read(Kept.of(mapfile, old), **after)
    return [*Changes.between(old, new).lines()]


def test_nodes_keep_cores_and_cpus_that_are_left_open(read: Read) -> None:
    before = {"a": "cluster: 1", "b": "cluster: 1", "c": "cluster: 2"}
    assert changes(read, before, before) == []
    after = {"new": "cluster: 1", "b": "cluster: 1", "c": "cluster: 2", "a": "cluster: 2"}
    assert changes(read, before, after) == [
        "a changes: cluster 1 core 1 -> cluster 2 core 2",
        "new is new: cluster 1 core 1",
    ]
    assert changes(read, before, {"c": "cluster: 2"}) == ["a is removed", "b is removed"]


def test_a_named_core_displaces_a_node_that_had_it_by_chance(read: Read) -> None:
    before = {"a": "cluster: 1", "b": "cluster: 1"}
    assert changes(read, before, {"a": "cluster: 1", "b": "cluster: 1, core: 1"}) == [
        "a changes: cluster 1 core 1 -> cluster 1 core 2",
        "b changes: cluster 1 core 2 -> cluster 1 core 1",
    ]


def test_what_changed_is_named(read: Read) -> None:
    before = {"a": "cluster: 1, core: 1"}
    definitions = {
        "env: {A: b}": "environment",
        "terminal: true": "terminal",
        "respawn: true": "launch rules",
    }
    for definition, words in definitions.items():
        after = {"a": f"cluster: 1, core: 1, {definition}"}
        assert changes(read, before, after) == [f"a changes: {words}"]
    named = {"a": f"cluster: 1, core: 1, host_cpu: {CPU}"}
    found = changes(read, named, before) + changes(read, before, named)
    assert all("host CPU" in line for line in found)
