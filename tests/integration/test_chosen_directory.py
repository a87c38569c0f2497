# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes, runs and tools whose platforms are in another directory than /dev/shm."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from support import (
    IS_MANYCORE,
    MAPFILES,
    environment,
    example_command,
    manycore_command,
    wait_until,
)

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="about the files of rmw_manycore"),
]


@pytest.fixture
def directory(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("chosen")
    path.chmod(0o700)
    return path


def manycore(directory: Path, platform: str, *words: str) -> subprocess.CompletedProcess[str]:
    env = environment(platform, MANYCORE_DIRECTORY=str(directory))
    command = manycore_command(*words)
    return subprocess.run(command, env=env, capture_output=True, text=True, timeout=60)


def test_nodes_and_tools_meet_there(start, directory, platform):
    chosen = {"MANYCORE_DIRECTORY": str(directory)}
    listener = start(example_command("listener"), cluster=2, **chosen)
    talker = start(example_command("talker"), **chosen)
    listener.wait_for("I heard")
    assert [path.name for path in directory.iterdir() if path.is_dir()] == [platform]
    assert "/chatter" in manycore(directory, platform, "topic", "list").stdout
    assert platform in manycore(directory, platform, "status").stdout
    assert talker.stop_node()
    assert listener.stop_node()
    wait_until(lambda: not (directory / platform).exists(), "the last process removes it")


def test_nodes_of_a_run_inherit_it(start, directory):
    command = manycore_command("run", MAPFILES / "talker_listener.yaml")
    run = start(command, MANYCORE_DIRECTORY=str(directory))
    run.wait_for("I heard")
    assert list(directory.glob("*/registry"))
    assert run.stop_node()


def test_the_doctor_shows_it(directory, platform):
    assert str(directory) in manycore(directory, platform, "doctor").stdout
    directory.chmod(0o755)
    assert f"chmod 700 {directory}" in manycore(directory, platform, "doctor").stdout


@pytest.mark.parametrize("words", [("status",), ("topic", "list"), ("clean",), ("doctor",)])
def test_one_that_is_not_there_is_refused(directory, platform, words):
    missing = directory / "missing"
    answer = manycore(missing, platform, *words)
    assert answer.returncode in {1, 2}, answer
    lines = [line for line in (answer.stdout + answer.stderr).splitlines() if "mkdir" in line]
    assert f"mkdir -m 700 {missing}" in lines[0]
    assert "Traceback" not in answer.stderr


def test_a_node_is_refused(start, directory):
    directory.chmod(0o755)
    node = start(example_command("talker"), MANYCORE_DIRECTORY=str(directory))
    assert node.wait() == 1, node
    assert f"chmod 700 {directory}" in node.output, node
