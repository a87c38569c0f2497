# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Shared memory that somebody has damaged gives an error; nobody crashes, hangs or follows it."""

from __future__ import annotations

import os
import random
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from processes import kill, processes_of
from support import IS_MANYCORE, PLATFORMS, Program, example_command, wait_until

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="damages the files of rmw_manycore"),
]

RANDOM = random.Random(7)
HEADER_BYTES = 64  # what every segment begins with: magic, layout version, size

DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "empty": lambda content: b"",
    "truncated": lambda content: content[: len(content) // 2],
    "cut_in_the_header": lambda content: content[:10],
    "zeroed": lambda content: bytes(len(content)),
    "random": lambda content: RANDOM.randbytes(len(content)),
    "foreign": lambda content: Path("/bin/sh").read_bytes()[: len(content)],
    "random_after_the_header": lambda content: (
        content[:HEADER_BYTES] + RANDOM.randbytes(len(content) - HEADER_BYTES)
    ),
}


@pytest.fixture
def directory(start, platform) -> Iterator[Path]:
    """Yield the directory of a platform on which a talker runs in cluster 1."""
    start(example_command("talker")).wait_for("Publishing")
    yield PLATFORMS / platform
    for pid in processes_of(platform):
        kill(pid)
    wait_until(lambda: not processes_of(platform), "the processes of the platform are gone")
    shutil.rmtree(PLATFORMS / platform, ignore_errors=True)


def replace(path: Path, content: bytes) -> None:
    """Put a file in the place of another one, which those who have it mapped still see."""
    new = path.with_name(path.name + ".new")
    new.touch(mode=0o600)
    new.write_bytes(content)
    new.rename(path)


def assert_refuses(newcomer: Program, path: Path) -> None:
    """The newcomer ends by itself, with an error that names the file."""
    status = newcomer.wait()
    assert status > 0, newcomer
    assert str(path) in newcomer.output or path.name in newcomer.output, newcomer


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("name", ["registry", "cluster-1"])
def test_segment(start, directory, name, damage):
    path = directory / name
    replace(path, DAMAGES[damage](path.read_bytes()))
    assert_refuses(start(example_command("listener")), path)


def test_segment_of_another_platform(start, directory):
    """A whole and valid registry, but of somebody else."""
    other = f"{directory.name}-other"
    talker = start(example_command("talker"), MANYCORE_PLATFORM=other)
    talker.wait_for("Publishing")
    replace(directory / "registry", (PLATFORMS / other / "registry").read_bytes())
    assert_refuses(start(example_command("listener")), directory / "registry")
    assert talker.stop() == 0


@pytest.mark.parametrize("kind", ["a_file", "a_directory", "a_link"])
def test_pipe_that_is_none(start, directory, kind):
    pipe = directory / "cluster-1.pipe"
    pipe.unlink()
    if kind == "a_file":
        pipe.write_bytes(RANDOM.randbytes(4096))
    elif kind == "a_directory":
        pipe.mkdir()
    else:
        pipe.symlink_to("/dev/zero")
    assert_refuses(start(example_command("listener")), pipe)


def test_garbage_in_a_pipe(start, directory):
    """The receive thread throws away what is no eMCOS message, and goes on with the next one."""
    listener = start(example_command("listener"), cluster=2)
    listener.wait_for("I heard")
    pipe = os.open(directory / "cluster-2.pipe", os.O_WRONLY)
    for size_bytes in (1, 7, 64, 100, 4096):
        os.write(pipe, RANDOM.randbytes(size_bytes))
    os.close(pipe)
    listener.skip_output()
    for _ in range(5):
        listener.wait_for("I heard: 'Hello World")


@pytest.mark.parametrize("damage", DAMAGES)
def test_leftovers_of_a_dead_platform(start, platform, damage):
    """Whatever a dead platform left is in nobody's way: the next start clears it up."""
    talker = start(example_command("talker"))
    talker.wait_for("Publishing")
    for pid in processes_of(platform):
        kill(pid)
    talker.wait()
    for name in ("registry", "cluster-1"):
        path = PLATFORMS / platform / name
        replace(path, DAMAGES[damage](path.read_bytes()))
    again = start(example_command("talker"))
    again.wait_for("Publishing")
    assert again.stop() == 0, again
