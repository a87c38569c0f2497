# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes started from a shell, one by one, with nothing else running."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from support import IS_MANYCORE, RMW, wait_until
from support.processes.commands import example_command
from support.processes.inspection import has_receive_threads
from support.processes.platforms import PLATFORMS, environment

pytestmark = pytest.mark.integration

needs_manycore = pytest.mark.skipif(not IS_MANYCORE, reason="looks at rmw_manycore's directory")

GROUPS = {
    "talker": ["talker", "listener"],
    "image": ["image_source", "image_filter", "image_sink"],
    "lamp": ["lamp", "lamp_switch"],
    "gain": ["controller", "tuner"],
    "action": ["fibonacci_server", "fibonacci_client"],
}

# Printed by a node while it spins, where that is not its first line.
FROM_A_CALLBACK = {"controller": "gain is now"}


@pytest.mark.parametrize("cluster", [1, 2], ids=["same_cluster", "other_cluster"])
def test_two_shells(start, cluster):
    talker = start(example_command("talker"))
    listener = start(example_command("listener"), cluster)
    for _ in range(3):
        listener.wait_for("I heard: 'Hello World")
    assert "Traceback" not in talker.output + listener.output
    assert talker.stop_node(), talker
    assert listener.stop_node(), listener


def test_listener_first(start):
    listener = start(example_command("listener"), cluster=2)
    talker = start(example_command("talker"))
    talker.wait_for("Publishing")
    listener.wait_for("I heard: 'Hello World")


def test_the_other_end_may_come_back(start):
    listener = start(example_command("listener"))
    for _ in range(3):
        talker = start(example_command("talker"), cluster=2)
        talker.wait_for("Hello World: 1")
        listener.wait_for("I heard: 'Hello World")
        assert talker.stop_node(), talker


@pytest.mark.parametrize("group", GROUPS)
def test_examples_end_quietly(start, group):
    """Interrupted at work, they end with status 0 and without a traceback."""
    programs = [start(example_command(name)) for name in GROUPS[group]]
    for name, program in zip(GROUPS[group], programs, strict=True):
        program.wait_for(FROM_A_CALLBACK.get(name, "INFO"))
    for program in programs:
        assert program.stop_node(), program
        if program.wait() == 0:  # else rclpy turned the interrupt into an error of its own
            assert "Traceback" not in program.output, program


@needs_manycore
def test_what_exists_while_a_node_runs_is_private(start, platform):
    start(example_command("talker")).wait_for("Publishing")
    directory = PLATFORMS / platform
    assert (directory / "registry").exists()
    wait_until(lambda: has_receive_threads(platform), "no process adds or removes files any more")
    for path in [PLATFORMS, directory, *directory.rglob("*")]:
        assert path.stat().st_mode & 0o077 == 0, f"others may use {path}"
        assert path.stat().st_uid == os.getuid()


@needs_manycore
def test_fast_dds_is_not_loaded(start):
    talker = start(example_command("talker"))
    talker.wait_for("Publishing")
    libraries = Path(f"/proc/{talker.pid}/maps").read_text()
    assert "librmw_manycore.so" in libraries
    assert "fastrtps.so.2" not in libraries or "standin" in libraries


def test_the_middleware_identifies_itself(platform):
    code = "import rclpy; print(rclpy.get_rmw_implementation_identifier())"
    command = [sys.executable, "-c", code]
    name = subprocess.check_output(command, env=environment(platform), text=True)
    assert name.strip() == RMW


@needs_manycore
def test_without_the_variable_nothing_changes(platform):
    code = "import rclpy; print(rclpy.get_rmw_implementation_identifier())"
    env = environment(platform)
    del env["RMW_IMPLEMENTATION"]
    name = subprocess.check_output([sys.executable, "-c", code], env=env, text=True)
    assert name.strip() == "rmw_fastrtps_cpp"
