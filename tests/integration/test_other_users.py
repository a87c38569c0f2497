# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Tools do not read, follow or remove what other users put where this user's platforms lie."""

from __future__ import annotations

import ctypes
import os
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.processes.commands import example_command, manycore_command
from support.processes.inspection import receive_threads_of
from support.processes.own_shm import can_mount, own_shm_command
from support.processes.platforms import PLATFORMS, environment
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.needs("nsenter"),
    pytest.mark.skipif(not IS_MANYCORE, reason="about the files of rmw_manycore"),
    pytest.mark.skipif(not can_mount(), reason="needs root and a mount namespace"),
]

OTHER_USER = 12345
REFUSAL = f"{PLATFORMS} is not a private directory of this user"
VERBS = (
    "status",
    "topic list",
    "node list",
    "top --count 1",
    "trace status",
    "bridge status",
    "clean",
)


@pytest.fixture
def talker(platform: str) -> Iterator[Program]:
    """Yield a node on a /dev/shm of its own."""
    talker = Program(own_shm_command(256, example_command("talker")), environment(platform))
    talker.wait_for("Publishing")
    yield talker
    talker.kill()


Manycore = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def manycore(talker: Program, platform: str) -> Manycore:
    """Return a function that runs the tool beside the talker."""

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            ["nsenter", "--mount", f"--target={talker.pid}", *manycore_command(*words)],
            env=environment(platform),
            capture_output=True,
            text=True,
            timeout=TIMEOUT_S,
        )

    return run


def give_away(directory: Path) -> None:
    """Give a directory to another user, as if its platform were that user's."""
    for path in (directory, *directory.rglob("*")):
        os.chown(path, OTHER_USER, OTHER_USER, follow_symlinks=False)


def exchange(one: Path, other: Path) -> None:
    """Exchange the names of two files in one step."""
    at_cwd, rename_exchange = -100, 2
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.renameat2(at_cwd, os.fsencode(one), at_cwd, os.fsencode(other), rename_exchange) != 0:
        raise OSError(ctypes.get_errno(), "cannot exchange", str(one), None, str(other))


@pytest.mark.parametrize("kind", ["directory", "link"])
def test_the_platform_of_another_user_is_refused(
    talker: Program, manycore: Manycore, platform: str, tmp_path: Path, kind: str
) -> None:
    """The other user could truncate its segments, which would end all that map them.

    Its receive threads end with its last node, and remove nothing.
    """
    assert platform in manycore("status").stdout
    receive_threads = receive_threads_of(platform)
    assert receive_threads
    shm_fd = os.open(f"/proc/{talker.pid}/root/dev/shm", os.O_RDONLY)  # outlives the talker
    shm = Path(f"/proc/self/fd/{shm_fd}")
    user_directory = theirs = shm / PLATFORMS.name
    if kind == "link":
        theirs = shm / "theirs"
        theirs.symlink_to(theirs.name)
        exchange(theirs, user_directory)  # at no moment are the talker's files gone
    give_away(theirs)
    files = sorted(theirs.rglob("*"))
    picture = str(tmp_path / "chip.svg")
    for words in (*map(str.split, VERBS), ["view", "--once", "-o", picture]):
        answer = manycore(*words)
        assert (answer.returncode, answer.stdout) == (1, ""), words
        assert answer.stderr.startswith(f"manycore: {REFUSAL}"), words
    talker.kill()
    for pid in receive_threads:
        wait_until(lambda pid=pid: not Path(f"/proc/{pid}").exists(), f"{pid} has ended")
    assert sorted(theirs.rglob("*")) == files
    os.close(shm_fd)


@pytest.mark.parametrize("verb", ["status", "bridge status", "clean"])
def test_the_link_of_a_platform_is_not_followed(
    talker: Program, manycore: Manycore, tmp_path: Path, verb: str
) -> None:
    directory = Path(f"/proc/{talker.pid}/root{PLATFORMS}")
    (tmp_path / "kept").touch()
    (directory / "link").symlink_to(tmp_path)
    option = () if verb == "clean" else ("--platform",)
    answer = manycore(*verb.split(), *option, "link")
    assert answer.returncode == 1
    assert "no platform 'link'" in answer.stderr or "link is not a private" in answer.stderr
    assert (tmp_path / "kept").exists()


def test_a_node_does_not_clear_the_target_of_a_link(talker: Program, tmp_path: Path) -> None:
    directory = Path(f"/proc/{talker.pid}/root{PLATFORMS}")
    (tmp_path / "kept").touch()
    (directory / "link").symlink_to(tmp_path)
    beside = ["nsenter", "--mount", f"--target={talker.pid}"]
    node = Program([*beside, *example_command("talker")], environment("link"))
    status = node.wait()
    node.kill()
    assert status == 1, node
    assert f"{PLATFORMS}/link is not a private directory" in node.output
    assert (tmp_path / "kept").exists()
