# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mapfiles that a bench completes so that they run by themselves."""

from __future__ import annotations

from pathlib import Path

import click
import pytest

from rmw_manycore_py.cli.bench.driven import driven
from rmw_manycore_py.mapfile import check
from rmw_manycore_py.mapfile.installed import find_mapfile

pytestmark = pytest.mark.unit


def installed(name: str) -> Path:
    found = find_mapfile(name)
    assert found is not None
    return found


@pytest.mark.parametrize("name", ["ros_lite.map", "whill.yaml"])
def test_only_the_installed_mapfile_gets_its_vehicle(name: str, tmp_path: Path) -> None:
    copy, directory = tmp_path / name, tmp_path / "complete"
    directory.mkdir()
    copy.write_bytes(installed(name).read_bytes())
    assert driven(copy, directory) != copy
    copy.write_text(copy.read_text() + "\n# ours\n")
    assert driven(copy, directory) == copy


def test_native_nodes_keep_their_places_and_topics(tmp_path: Path) -> None:
    ordinary = check(installed("autoware_reference"))
    native = check(driven(installed("autoware_reference"), tmp_path, native=True))
    assert [(node.name, node.cluster, node.core) for node in native.nodes] == [
        (node.name, node.cluster, node.core) for node in ordinary.nodes
    ]
    with pytest.raises(click.UsageError):
        driven(installed("talker_listener"), tmp_path, native=True)
