# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore clean` cures each state whose error names it, and says what it leaves and why."""

from __future__ import annotations

import ctypes
import json
import random
import re
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from support import IS_MANYCORE, wait_until
from support.peers.programs import forked_example, forked_manycore
from support.processes.inspection import kill, kill_all, processes_of, stop_all
from support.processes.platforms import PLATFORMS
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

HEAD_BYTES = 1 << 16
LIFELINE_BYTES = 64  # size of the header of `alive`, and of each line

Damage = Callable[[Path], None]


def overwritten(path: Path) -> None:
    """Damage a file in place: members that run see it, too."""
    with path.open("r+b") as file:
        file.write(random.Random(5).randbytes(min(HEAD_BYTES, path.stat().st_size)))


def lines_overwritten(path: Path) -> None:
    """Damage all lines of `alive`: each seems to be held."""
    size = path.stat().st_size
    with path.open("r+b") as file:
        file.seek(LIFELINE_BYTES)
        file.write(b"\xff" * (size - LIFELINE_BYTES))


def truncated(path: Path) -> None:
    """Replace a file by an empty one: truncated in place, it would kill its users."""
    new = path.with_name("new")
    new.touch(mode=0o600)
    new.rename(path)


def a_directory(path: Path) -> None:
    """Put a directory in the place of a file, which is never missing meanwhile."""
    new = path.with_name("new")
    new.mkdir()
    (new / "file").touch()
    exchange = 2  # RENAME_EXCHANGE
    at = -100  # AT_FDCWD
    assert ctypes.CDLL(None).renameat2(at, bytes(new), at, bytes(path), exchange) == 0
    new.unlink()


def absent(path: Path) -> None:
    path.unlink()


DAMAGES = [overwritten, truncated, a_directory, absent]
OTHERS: list[tuple[str, Damage]] = [
    *(("registry", damage) for damage in DAMAGES),
    *(("cluster-1", damage) for damage in DAMAGES),
    *(("cluster-1.pipe", damage) for damage in (truncated, a_directory, absent)),
]


def named(value: object) -> str:
    return getattr(value, "__name__", str(value))


@pytest.fixture
def talker(start) -> Program:
    program: Program = start(forked_example("talker"))
    program.wait_for("Publishing")
    return program


@pytest.fixture
def clean(start) -> Callable[..., Program]:
    def call(*words: str, status: int = 0) -> Program:
        program = start(forked_manycore("clean", *words))
        assert program.wait() == status, program
        return program

    return call


@pytest.fixture
def private_directory() -> Iterator[dict[str, str]]:
    """Yield the variable of a directory without the platforms of other tests."""
    with tempfile.TemporaryDirectory(dir="/dev/shm") as directory:
        yield {"MANYCORE_DIRECTORY": directory}


@pytest.mark.parametrize("damage", [overwritten, truncated, a_directory], ids=named)
def test_damaged_lifelines_are_cured(start, clean, talker, platform, damage: Damage) -> None:
    """The receive thread stays, as it cannot tell that its node has died: clean ends it."""
    damage(PLATFORMS / platform / "alive")
    talker.kill()
    refused = start(forked_example("talker"))
    assert refused.wait() == 1
    assert_cured(start, clean, platform)


def test_a_receive_thread_that_misses_the_lifelines_removes_its_platform(
    start, talker, platform
) -> None:
    absent(PLATFORMS / platform / "alive")
    wait_until(lambda: not (PLATFORMS / platform).exists(), "the platform is removed")
    talker.kill()
    assert_gone(start, platform)


@pytest.mark.parametrize(("name", "damage"), OTHERS, ids=named)
def test_damaged_files_are_cured(start, clean, talker, platform, name, damage: Damage) -> None:
    stop_all(platform)
    damage(PLATFORMS / platform / name)
    for pid in processes_of(platform):
        kill(pid)
    assert_cured(start, clean, platform)


def assert_cured(start, clean, platform: str) -> None:
    assert clean(platform).lines
    assert_gone(start, platform)


def assert_gone(start, platform: str) -> None:
    assert not (PLATFORMS / platform).exists()
    wait_until(lambda: not processes_of(platform), "receive threads have ended")
    again = start(forked_example("talker"))
    again.wait_for("Publishing")
    assert again.stop_node()


def test_a_damaged_platform_in_use_is_left_alone(clean, talker, platform) -> None:
    alive = PLATFORMS / platform / "alive"
    whole = alive.read_bytes()
    for damage in (overwritten, lines_overwritten):
        damage(alive)
        for words in ((platform,), ("--force", platform)):
            said = clean(*words, status=1).lines[-1]
            assert f"platform '{platform}' is alive; stop its nodes first: " in said
            assert f"({talker.pid})" in said
    with alive.open("r+b") as file:
        file.write(whole)
    assert talker.stop_node()


def test_a_dead_platform_is_not_offered(clean, talker, platform, start) -> None:
    def said() -> str:
        drawn = start(forked_manycore("view", "--platform", "none", "--once", "-o", "/nowhere.svg"))
        assert drawn.wait() == 1, drawn
        return drawn.output

    assert re.search(rf"no platform 'none'; there is .*\b{platform}\b.* \(--platform\)", said())
    kill_all(platform)
    assert (PLATFORMS / platform).exists()
    assert "no platform 'none'" in (text := said())
    assert platform not in text
    assert clean(platform).lines


def test_lines_that_seem_held_need_force(clean, talker, platform) -> None:
    kill_all(platform)
    lines_overwritten(PLATFORMS / platform / "alive")
    said = clean(platform, status=1).lines[-1]
    assert f"'manycore clean --force {platform}'" in said
    assert (PLATFORMS / platform).exists()
    assert clean("--force", platform).lines
    assert not (PLATFORMS / platform).exists()


def test_clean_reports_what_it_leaves(start, private_directory, platform) -> None:
    """Without names it is no failure to leave live platforms alone."""

    def clean(*words: str, status: int = 0) -> Program:
        program = start(forked_manycore("clean", *words), **private_directory)
        assert program.wait() == status, program
        return program

    assert clean().lines == ["nothing to remove"]
    talker = start(forked_example("talker"), **private_directory)
    talker.wait_for("Publishing")
    alive = f"platform '{platform}' is alive; stop its nodes first: "
    assert f"notice: {alive}" in clean().output
    assert json.loads(clean("--json", "--logs").output) == {"removed": []}
    assert f"manycore: {alive}" in clean(platform, status=1).output
    assert "no platform 'none'" in clean("none", status=1).output
    assert "--force requires PLATFORMS" in clean("--force", status=2).output
    assert talker.stop_node()
