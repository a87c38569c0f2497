# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Errors from outside a command are one line of `manycore: ...`, whatever the verb."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from support import IS_MANYCORE, TIMEOUT_S
from support.peers.programs import forked_example
from support.processes.commands import manycore_command
from support.processes.platforms import environment

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

SHORT_RUN = ("talker_listener", "--duration", "1")
# Verbs that print without a platform, and verbs that join the one of a talker.
PRINTING = [
    ("--help",),
    ("--version",),
    ("run", "--help"),
    ("status",),
    ("ps",),
    ("doctor",),
    ("env",),
    ("completion", "bash"),
    ("map", "check", "talker_listener"),
    ("map", "show", "--json", "talker_listener"),
    ("interface", "list"),
    ("run", *SHORT_RUN),
    ("demo", "--duration", "1"),
]
LOOKING = [
    ("topic", "list"),
    ("topic", "echo", "/chatter"),
    ("topic", "pub", "-t", "1", "/x", "std_msgs/msg/String", "{}"),
    ("node", "list"),
    ("top", "--json"),
]
USING_THE_DIRECTORY = [
    ("run", *SHORT_RUN),
    ("run", "talker_listener", "--join"),
    ("up", "-d", "talker_listener"),
    ("demo", "--duration", "1"),
    ("stop",),
    ("clean",),
    ("status",),
    ("topic", "list"),
    ("topic", "echo", "/x", "std_msgs/msg/String"),
    ("topic", "pub", "-t", "1", "/x", "std_msgs/msg/String", "{}"),
    ("topic", "hz", "/x"),
    ("service", "call", "/x", "std_srvs/srv/SetBool", "{}"),
    ("trace", "start"),
]


def named(words: tuple[str, ...]) -> str:
    return " ".join(words[:2])


def last_line(platform: str, words: tuple[str, ...], output: Path, **more: str) -> str:
    """Run a command that fails; return the last line of its standard error."""
    with output.open("w") as stdout:
        done = subprocess.run(
            manycore_command(*words),
            env=environment(platform, **more),
            stdout=stdout,
            stderr=subprocess.PIPE,
            text=True,
            timeout=TIMEOUT_S,
        )
    assert done.returncode == 1, done
    assert "Traceback" not in done.stderr
    assert "Exception ignored" not in done.stderr
    return done.stderr.splitlines()[-1]


@pytest.mark.parametrize("words", PRINTING, ids=named)
def test_a_full_disk_is_named(platform: str, words: tuple[str, ...]) -> None:
    said = last_line(platform, words, Path("/dev/full"))
    assert said == "manycore: the output cannot be written: No space left on device"


def test_a_full_disk_is_named_by_verbs_that_join(start, platform: str) -> None:
    start(forked_example("talker")).wait_for("Publishing")
    for words in LOOKING:
        said = last_line(platform, words, Path("/dev/full"))
        assert said == "manycore: the output cannot be written: No space left on device", words


@pytest.mark.parametrize("words", USING_THE_DIRECTORY, ids=named)
def test_a_directory_of_others_is_named(platform: str, tmp_path, words: tuple[str, ...]) -> None:
    directory = tmp_path / "open"
    directory.mkdir()
    directory.chmod(0o755)
    output = tmp_path / "output"
    said = last_line(platform, words, output, MANYCORE_DIRECTORY=str(directory))
    assert said.startswith("manycore: ")
    assert f"MANYCORE_DIRECTORY='{directory}' is open to other users (mode 755)" in said
