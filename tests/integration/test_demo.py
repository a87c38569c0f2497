# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore demo`, and mapfiles by the names they are installed under."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from support import MAPFILES
from support.nodes import timed
from support.processes.commands import manycore_command

pytestmark = pytest.mark.integration


def test_the_demo_runs_and_describes_its_output(start, tmp_path: Path) -> None:
    demo = start(manycore_command("demo", "--duration", "60"), directory=tmp_path)
    demo.wait_for("a talker on core 1 of cluster 1, a listener on core 1 of cluster 2")
    demo.wait_for("listener .*I heard")
    demo.signal(signal.SIGINT)
    demo.wait_for("stopping: SIGINT")
    demo.wait_for("/listener: cluster 2, core 1, host CPU")
    demo.wait_for("manycore run talker_listener ")
    demo.wait_for("manycore topic echo /chatter ")
    assert demo.wait() == 0


def test_the_demos_are_listed(start, tmp_path: Path) -> None:
    demo = start(manycore_command("demo", "--list"), directory=tmp_path)
    assert demo.wait() == 0
    names = {line.split()[0] for line in demo.lines[1:]}
    assert names == {*(file.stem for file in MAPFILES.glob("*[a-z].yaml"))} - {
        "services_parameters.params"
    } | {"ros_lite", "three_nodes.map"}  # the suffix where another file has the same stem


@pytest.mark.parametrize(
    ("verb", "text"),
    [
        (("map", "check"), "three_nodes.yaml: 3 nodes in 2 clusters"),
        (("map", "show"), "/listener2"),
        (("create", "-o", "created"), "created/nodes/listener2.sh"),
    ],
)
def test_other_verbs_know_the_names(
    start, tmp_path: Path, verb: tuple[str, ...], text: str
) -> None:
    named = start(manycore_command(*verb, "three_nodes"), directory=tmp_path)
    assert named.wait() == 0, named
    assert text in named.output


def test_a_mapfile_asks_for_virtual_time(start, timed_mapfile) -> None:
    file = timed_mapfile(timed, "talker", "echo")
    file.write_text(f"clock: virtual\n{file.read_text()}")
    demo = start(manycore_command("demo", file, "--duration", "1"))
    assert demo.wait() == 0
    assert demo.wait_for(r"heard talker 1 \d+ (\d{9})\d{10}$")[1] == "100000000"


def test_a_file_of_the_working_directory_wins(start, tmp_path: Path) -> None:
    (tmp_path / "talker_listener.yaml").write_text(
        "nodes: {own: {cluster: 1, command: ['true'], ros_arguments: false}}\n"
    )
    run = start(manycore_command("run", "talker_listener"), directory=tmp_path)
    assert run.wait() == 0
    assert "own finished" in run.output
