# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Damaged shared memory gives an error; no process crashes, hangs or follows it."""

from __future__ import annotations

import os
import random
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from support import IS_MANYCORE
from support.peers.programs import forked_example
from support.processes.inspection import kill_all, stop_all
from support.processes.platforms import PLATFORMS
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="damages the files of rmw_manycore"),
]

OFTEN = ("--ros-args", "-p", "rate_hz:=20.0")
RANDOM = random.Random(7)
SEEDS = range(1, 7)
HEADER_BYTES = 64  # header of every segment: magic, layout version, size

# A segment is as large as its cluster's memory, but sparse; the part in use is at its beginning.
HEAD_BYTES = 1 << 20

# From the head of a file and its size to those of the damaged one.
Damage = Callable[[bytes, int], tuple[bytes, int]]

DAMAGES: dict[str, Damage] = {
    "empty": lambda head, size: (b"", 0),
    "truncated": lambda head, size: (head, size // 2),
    "cut_in_the_header": lambda head, size: (head[:10], 10),
    "zeroed": lambda head, size: (b"", size),
    "random": lambda head, size: (RANDOM.randbytes(len(head)), size),
    "foreign": lambda head, size: (Path("/bin/sh").read_bytes(), size),
}


@pytest.fixture
def running(start, platform) -> Iterator[Path]:
    """Yield the directory of a platform on which a talker runs in cluster 1."""
    start(forked_example("talker", *OFTEN)).wait_for("Publishing")
    yield PLATFORMS / platform
    kill_all(platform)
    shutil.rmtree(PLATFORMS / platform, ignore_errors=True)


@pytest.fixture
def directory(running, platform) -> Path:
    """Return the directory of a platform whose members are stopped.

    If running, they would notice that another file has replaced one that they use.
    """
    stop_all(platform)
    return running


def damage_file(path: Path, damage: Damage) -> None:
    """Replace a file by a damaged copy; processes that have it mapped still see the original."""
    with path.open("rb") as file:
        content, size_bytes = damage(file.read(HEAD_BYTES), path.stat().st_size)
    copy = path.with_name(path.name + ".new")
    copy.touch(mode=0o600)
    copy.write_bytes(content)
    os.truncate(copy, size_bytes)
    copy.rename(path)


def assert_refuses(newcomer: Program, directory: Path) -> None:
    """Check that a new process fails with an error that names a file of the platform."""
    status = newcomer.wait()
    assert status > 0, newcomer
    assert f"{directory}/" in newcomer.output, newcomer


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("name", ["registry", "cluster-1"])
def test_segment(start, directory, name, damage):
    damage_file(directory / name, DAMAGES[damage])
    assert_refuses(start(forked_example("listener")), directory)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ["registry", "cluster-1"])
def test_segment_that_is_random_after_its_header(start, directory, name, seed):
    """The header is valid, so the code that first reads the rest has to detect the damage."""
    noise = random.Random(seed)

    def damage(head: bytes, size: int) -> tuple[bytes, int]:
        return head[:HEADER_BYTES] + noise.randbytes(len(head) - HEADER_BYTES), size

    damage_file(directory / name, damage)
    newcomer = start(forked_example("listener"))
    assert newcomer.wait() == 1, newcomer
    assert "RCLError" in newcomer.output, newcomer


def test_segment_of_another_version(start, directory):
    """It is smaller than ours, yet the error is about the version."""

    def damage(head: bytes, size: int) -> tuple[bytes, int]:
        magic, version, rest = head[:8], head[8:12], head[12:]
        return magic + bytes([version[0] + 1]) + version[1:] + rest, size // 2

    damage_file(directory / "registry", damage)
    newcomer = start(forked_example("listener"))
    assert_refuses(newcomer, directory)
    assert "has layout version" in newcomer.output, newcomer


def test_segment_of_another_platform(start, directory):
    """The registry is complete and valid, but belongs to another platform."""
    other = f"{directory.name}-other"
    talker = start(forked_example("talker", *OFTEN), MANYCORE_PLATFORM=other)
    talker.wait_for("Publishing")
    shutil.copy(PLATFORMS / other / "registry", directory / "copy")
    (directory / "copy").rename(directory / "registry")
    assert_refuses(start(forked_example("listener")), directory)
    assert talker.stop_node()


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
    assert_refuses(start(forked_example("listener")), directory)


def test_garbage_in_a_pipe(start, running):
    """The receive thread drops what is not an eMCOS message and goes on with the next one."""
    listener = start(forked_example("listener"), cluster=2)
    listener.wait_for("I heard")
    pipe = os.open(running / "cluster-2.pipe", os.O_WRONLY)
    for size_bytes in (1, 7, 64, 100, 4096):
        os.write(pipe, RANDOM.randbytes(size_bytes))
    os.close(pipe)
    listener.skip_output()
    for _ in range(5):
        listener.wait_for("I heard: 'Hello World")


@pytest.mark.parametrize("damage", DAMAGES)
def test_leftovers_of_a_dead_platform(start, platform, damage):
    """The next start removes whatever a dead platform left."""
    talker = start(forked_example("talker", *OFTEN))
    talker.wait_for("Publishing")
    kill_all(platform)
    for name in ("registry", "cluster-1"):
        damage_file(PLATFORMS / platform / name, DAMAGES[damage])
    again = start(forked_example("talker", *OFTEN))
    again.wait_for("Publishing")
    assert again.stop_node(), again
