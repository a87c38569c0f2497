# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The extension of `ros2 launch` without launch itself, on a real platform."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from rmw_manycore_py.errors import ManycoreError, MapfileError
from rmw_manycore_py.extensions.foreign_launch import ForeignLaunch
from rmw_manycore_py.native import _transport
from support import IS_MANYCORE
from support.processes.platforms import leftovers

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="extensions are part of rmw_manycore"),
]


@pytest.fixture
def begin(
    tmp_path: Path, platform: str, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Callable[[str], ForeignLaunch]]:
    """Yield a function that begins a launch with the nodes of a mapfile."""
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_manycore")
    monkeypatch.setenv("MANYCORE_PLATFORM", "")
    launches: list[ForeignLaunch] = []

    def begin_launch(nodes: str) -> ForeignLaunch:
        file = tmp_path / "map.yaml"
        file.write_text(f"platform: {{profile: coolidge, name: {platform}}}\nnodes:\n{nodes}")
        launches.append(ForeignLaunch(str(file)))
        return launches[-1]

    yield begin_launch
    for launch in launches:
        launch.close()


def test_it_holds_the_platform_of_the_mapfile(begin, platform: str) -> None:
    launch = begin("  one: {cluster: 1}\n")
    with _transport.Platform(platform) as view:
        assert (view.info().clusters, view.info().alive) == (5, True)
    assert os.environ["MANYCORE_PLATFORM"] == platform
    launch.close()
    assert leftovers(platform) == []


def test_names_and_numbers_are_those_of_manycore_run(begin) -> None:
    launch = begin(
        "  two: {cluster: 1, core: 1}\n  two_2: {cluster: 1, core: 2}\n  x: {cluster: 2}\n"
    )
    assert launch.place("two", "/", "talker").core == 1
    assert launch.place("two", "/", "talker").core == 2
    assert launch.place("two", "/", "talker") is None
    assert launch.place(None, "/", "x.py").cluster == 2
    assert launch.not_started == []


def test_a_name_in_full_means_one_node(begin) -> None:
    launch = begin("  /left/two: {cluster: 1}\n  absent: {cluster: 2}\n")
    assert launch.place("two", "/right", "talker") is None
    assert launch.place("two", "/left", "talker").cluster == 1
    assert launch.not_started == ["absent"]


def test_a_name_of_two_nodes_is_an_error(begin) -> None:
    launch = begin("  two: {cluster: 1}\n")
    launch.place("two", "/left", "talker")
    with pytest.raises(MapfileError, match="found several: /left/two, /right/two"):
        launch.place("two", "/right", "talker")


def test_the_launch_file_decides_what_the_mapfile_does_not_but_the_place(begin) -> None:
    launch = begin("  one: {cluster: 2, core: 3, env: {A: map}}\n")
    placed = launch.place("one", "/", "talker")
    given = {**os.environ, "A": "launch", "MANYCORE_WAIT": "spin", "MANYCORE_CLUSTER": "5"}
    environment = launch.environment(placed, given)
    names = ("A", "MANYCORE_WAIT", "MANYCORE_CLUSTER", "MANYCORE_CORE")
    assert [environment[name] for name in names] == ["map", "spin", "2", "3"]


def test_nodes_of_another_domain_are_not_on_the_platform(begin, platform: str) -> None:
    launch = begin("  one: {cluster: 2}\n")
    placed = launch.place("one", "/", "talker")
    other = {**os.environ, "ROS_DOMAIN_ID": "200"}
    names = ("MANYCORE_PLATFORM", "MANYCORE_CLUSTER", "MANYCORE_CORE")
    assert [launch.environment(placed, other)[name] for name in names] == ["", "", ""]
    assert launch.elsewhere(other) == dict.fromkeys(names, "")
    assert launch.environment(placed, dict(os.environ))["MANYCORE_PLATFORM"] == platform
    assert launch.elsewhere(os.environ) == {}


def test_errors_say_what_is_expected(begin, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ManycoreError, match="MANYCORE_MAPFILE: expected a mapfile, found 'no'"):
        ForeignLaunch("no")
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_cyclonedds_cpp")
    with pytest.raises(
        ManycoreError, match="expected RMW_IMPLEMENTATION=rmw_manycore, found rmw_cy"
    ):
        begin("  one: {cluster: 1}\n")
