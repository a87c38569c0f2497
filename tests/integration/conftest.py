# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fixtures of the tests of whole programs."""

from __future__ import annotations

import json
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

from support import wait_until
from support.installs.installing import Installation, pack_wheel
from support.nodes.bridging import Bridge
from support.peers.programs import forked_example, forked_manycore
from support.processes.platforms import leftovers, unique_platform
from support.session.sharing import made_once


@pytest.fixture(scope="session")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of this checkout for this python."""
    return pack_wheel(tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="session")
def installation(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Installation:
    """An environment with that wheel."""
    return Installation(Path(sys.executable), wheel, tmp_path_factory.mktemp("installed") / "venv")


@pytest.fixture
def bridge(start, platform) -> Bridge:
    """Return the test's bridge, which starts nodes inside and outside."""
    return Bridge(start, platform)


@pytest.fixture
def other_platform() -> Iterator[str]:
    """Return the name of a second platform, which leaves nothing."""
    name = unique_platform()
    yield name
    wait_until(lambda: not leftovers(name), f"{name} leaves nothing in /dev/shm")


@pytest.fixture
def talking(start):
    """Start a talker on core 3 and a listener in clusters of their own, and wait for a message."""
    listener = start(forked_example("listener"), cluster=2)
    often = ("--ros-args", "-p", "rate_hz:=20.0")
    talker = start(forked_example("talker", *often), MANYCORE_CORE="3")
    listener.wait_for("I heard")
    return talker, listener


@pytest.fixture
def manycore(start):
    """Return a function that runs a verb and returns its output."""

    def call(*words: object, status: int = 0, **variables: str) -> str:
        program = start(forked_manycore(*words), **variables)
        assert program.wait() == status, program
        return program.output

    return call


@pytest.fixture
def view(start):
    """Start a viewer; return it and its URL."""
    program = start(forked_manycore("view", "--port", "0", "--period", "0.2"))
    link = program.wait_for(r"http://\S+").group()
    yield program, link
    if program.is_running():
        assert program.stop() == 0, program


@pytest.fixture(scope="session")
def chromium(tmp_path_factory):
    from support.processes.browser import Browser

    opened = Browser(tmp_path_factory.mktemp("downloads"))
    yield opened
    opened.close()


@pytest.fixture
def browser(chromium):
    yield chromium
    chromium.forget()


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a directory with a drive of ten scans and its map."""
    return made_once(tmp_path_factory, "street", simulate)


def simulate(directory: Path) -> None:
    from click.testing import CliRunner

    from rmw_manycore_py.cli.main import cli

    arguments = ["ndt", "simulate", str(directory), "--length", "8"]
    result = CliRunner().invoke(cli, arguments)
    assert result.exit_code == 0, result.output


@pytest.fixture
def timed_mapfile(tmp_path: Path):
    """Return a function that writes a mapfile of nodes of a script, on two clusters in turn."""

    def write(script: ModuleType, *names: str, rules: str = "") -> Path:
        file = tmp_path / "map.yaml"
        lines = (
            f"  {name}: {{command: [{sys.executable}, {script.__file__}, {name}], "
            f"cluster: {index % 2 + 1}{rules}}}\n"
            for index, name in enumerate(names)
        )
        file.write_text("platform: coolidge\nnodes:\n" + "".join(lines))
        return file

    return write


@pytest.fixture
def log_of(start):
    """Return a function that runs a mapfile in virtual time; it returns what each node printed."""

    def run(mapfile: Path, duration_s: float, *options: str) -> dict[str, list[str]]:
        time = ("--virtual", *(options or ("--instant",)), "--duration", f"{duration_s}")
        run = start(forked_manycore("run", mapfile, *time, "--json"))
        run.wait_for(r'"event": "finished"')
        assert run.wait() == 0
        log = defaultdict(list)
        for line in run.output.splitlines():
            event = json.loads(line)
            if event["event"] == "output":
                log[event["node"]].append(event["line"])
        return dict(log)

    return run
