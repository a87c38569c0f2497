# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes, runs and tools whose platforms are in another directory than /dev/shm."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from support import IS_MANYCORE, MAPFILES, wait_until
from support.processes.commands import example_command, manycore_command
from support.processes.platforms import environment
from support.sources.advice import quoted, run_quoted

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="about the files of rmw_manycore"),
]


@pytest.fixture
def directory(tmp_path_factory) -> Path:
    path: Path = tmp_path_factory.mktemp("chosen") / "by the user's choice"
    path.mkdir(mode=0o700)
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
    run_quoted(manycore(directory, platform, "doctor").stdout, "chmod 700")
    link = directory.with_name("link")
    link.symlink_to(directory)
    assert "chmod" not in manycore(link, platform, "doctor").stdout


def test_the_doctor_leaves_a_directory_for_all_users_as_it_is(directory, platform):
    directory.chmod(0o1777)
    output = manycore(directory, platform, "doctor").stdout
    assert "chmod" not in output
    run_quoted(output, "mkdir")
    chosen = directory / "manycore"
    assert f"ok       platform directory: {chosen}" in manycore(chosen, platform, "doctor").stdout


@pytest.mark.parametrize("words", [("status",), ("topic", "list"), ("clean",), ("doctor",)])
def test_one_that_is_not_there_is_refused(directory, platform, words):
    missing = directory / "is" / "missing"
    answer = manycore(missing, platform, *words)
    assert answer.returncode in {1, 2}, answer
    assert "Traceback" not in answer.stderr
    run_quoted(answer.stdout + answer.stderr, "mkdir")
    there = manycore(missing, platform, *words)
    assert "MANYCORE_DIRECTORY" not in there.stdout + there.stderr


@pytest.mark.parametrize("words", [("status",), ("topic", "list")])
def test_one_that_cannot_be_made_there_is_not_advised_to_be_made(directory, platform, words):
    file = directory / "file"
    file.touch()
    answer = manycore(file, platform, *words)
    assert "is not a directory" in answer.stderr
    assert quoted(answer.stderr) == []


@pytest.mark.parametrize(("mode", "advice"), [(0o755, "chmod 700"), (0o1777, "mkdir")])
def test_a_node_is_refused(start, directory, mode, advice):
    directory.chmod(mode)
    node = start(example_command("talker"), MANYCORE_DIRECTORY=str(directory))
    assert node.wait() == 1, node
    run_quoted(node.output, advice)
    chosen = directory / "manycore" if advice == "mkdir" else directory
    talker = start(example_command("talker"), MANYCORE_DIRECTORY=str(chosen))
    talker.wait_for("Publishing")
    assert talker.stop_node()
