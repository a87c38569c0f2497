# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Directories of runs and their logs: limits, order, full disks, and liveness."""

from __future__ import annotations

import grp
import os
import pwd
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.runs import log_file
from rmw_manycore_py.launch.runs.directory import (
    RunDirectory,
    all_runs,
    new_run,
    remove_ended,
    runs_of,
)
from rmw_manycore_py.launch.runs.lines import MAX_LINE_BYTES, LineBuffer, encoded
from rmw_manycore_py.launch.runs.log_file import LogFile, log_path, share_of
from rmw_manycore_py.launch.runs.log_reader import NodeLog, in_order
from support.sources.advice import quoted, run_quoted

pytestmark = pytest.mark.unit

STATE = "the user's state"
LINE = "x" * 100
# Writes a line, two that do not fit, and one once there is space again.
FULL_DISK = """
import resource, signal, sys
from pathlib import Path
from rmw_manycore_py.launch.runs.log_file import LogFile
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
log = LogFile(Path(sys.argv[1]), "node", 1 << 20)
limit = lambda size: resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))
limit(int(sys.argv[2]))
print([log.write(text) for text in ("first", "second", "third")])
limit(1 << 20)
print(log.write("fourth"))
limit(int(sys.argv[2]))
print(log.write("fifth"))
limit(1 << 20)
log.close()
"""
HOLD = """
import sys
from rmw_manycore_py.launch.runs.directory import new_run
with new_run("platform", {"nodes": ["a"]}, joins=False) as own:
    print("held", flush=True)
    sys.stdin.read()
"""


@pytest.fixture(autouse=True)
def state(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("MANYCORE_STATE", str(tmp_path / STATE))
    return tmp_path / STATE


def run_in(directory: Path) -> RunDirectory:
    run = RunDirectory(directory / "1")
    run.logs.mkdir(parents=True)
    return run


def texts(log: NodeLog) -> list[str]:
    return [line.text for line in log.read()]


def test_a_log_is_bounded_and_keeps_the_newest(tmp_path: Path) -> None:
    run = run_in(tmp_path)
    log = LogFile(run.logs, "/ns/node", max_bytes=4000)
    for number in range(1000):
        log.write(f"{LINE} {number}")
    files = list(run.logs.iterdir())
    assert {file.name for file in files} == {"ns.node.log", "ns.node.log.1"}
    assert sum(file.stat().st_size for file in files) <= 4000
    numbers = [int(text.split()[1]) for text in texts(NodeLog(run, "/ns/node"))]
    assert numbers == list(range(numbers[0], 1000))
    assert len(numbers) > 4000 // 2 // 150


def test_a_follower_reads_across_the_halves(tmp_path: Path) -> None:
    run = run_in(tmp_path)
    log = LogFile(run.logs, "node", max_bytes=4000)
    reader = NodeLog(run, "node")
    assert texts(reader) == []
    seen = []
    for number in range(100):
        log.write(f"{LINE} {number}")
        if number % 5 == 0:
            seen += texts(reader)
    seen += texts(reader)
    assert [int(text.split()[1]) for text in seen] == list(range(100))


def test_logs_are_merged_by_time_and_cut_by_node(tmp_path: Path) -> None:
    run = run_in(tmp_path)
    one, two = (LogFile(run.logs, name, 1 << 20) for name in ("one", "two"))
    for number in range(3):
        one.write(f"{number}")
        two.write(f"{number}")
    lines = list(in_order([NodeLog(run, "two"), NodeLog(run, "one")], tail=2))
    assert [(line.node, line.text) for line in lines] == [
        *(("one", "1"), ("two", "1")),
        *(("one", "2"), ("two", "2")),
    ]


@pytest.mark.parametrize("room", [35, 60], ids=["nothing fits", "a part fits"])
def test_lines_that_a_full_disk_has_no_room_for_are_counted(tmp_path: Path, room: int) -> None:
    run = run_in(tmp_path)
    result = subprocess.run(
        [sys.executable, "-c", FULL_DISK, run.logs, str(room)],
        check=True,
        capture_output=True,
        text=True,
    )
    assert result.stdout.splitlines() == ["[None, 'File too large', None]", "None", "None"]
    found = texts(NodeLog(run, "node"))
    assert found[0] == "first"
    assert found[-3:] == [
        "(2 lines were not written: File too large)",
        "fourth",
        "(1 lines were not written: File too large)",
    ]


def test_nodes_share_what_a_run_may_keep() -> None:
    assert share_of(1) == log_file.MAX_NODE_BYTES
    assert 1000 * share_of(1000) <= log_file.MAX_RUN_BYTES
    assert share_of(10**6) == log_file.MIN_NODE_BYTES


def test_a_run_lives_as_long_as_its_process() -> None:
    holder = subprocess.Popen(
        [sys.executable, "-c", HOLD], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    assert holder.stdout is not None
    assert holder.stdout.readline() == b"held\n"
    (run,) = runs_of("platform")
    assert run.is_alive
    assert run.info["pid"] == holder.pid
    with pytest.raises(ManycoreError, match="is running already"), new_run("platform", {}, False):
        pass
    with new_run("platform", {}, joins=True) as second:
        assert second.directory.number == 2
    assert remove_ended() == [second.directory.path]
    holder.send_signal(signal.SIGKILL)
    holder.communicate()
    run.wait()
    assert not run.is_alive
    assert run.killed_after is not None
    with new_run("platform", {}, joins=True):
        assert run.killed_after is None, "a run of its mapfile has taken it up"
    with new_run("platform", {}, joins=False) as third:
        assert third.directory.number == 1, "it has taken the place of what has ended"
        assert third.directory.killed_after is None
        with third.directory.connect(1) as client:
            client.settimeout(1)
            third.listener.accept()[0].close()
    assert third.directory.killed_after is None, "it has ended"
    remove_ended("platform")
    assert runs_of("platform") == []


def test_a_long_path_takes_a_socket(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MANYCORE_STATE", str(tmp_path / ("long" * 40)))
    with new_run("platform", {}, joins=False) as own, own.directory.connect(1):
        assert len(str(own.directory.path)) > 107


def test_platforms_of_another_directory_have_runs_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with new_run("platform", {}, joins=False):
        monkeypatch.setenv("MANYCORE_DIRECTORY", str(tmp_path))
        assert runs_of("platform") == []


@pytest.mark.parametrize("text", ["[" * 100_000, "5", '{"nodes": 5}', "", "\0"])
def test_a_damaged_file_of_a_run_is_no_information(tmp_path: Path, text: str) -> None:
    run = run_in(tmp_path)
    (run.path / "run.json").write_text(text)
    assert run.nodes == []


def test_messages_are_cut_at_lines() -> None:
    lines = LineBuffer()
    data = encoded({"do": "state"}) + encoded({"do": "stop"})
    assert lines.take(data[:5]) == []
    assert lines.take(data[5:]) == [{"do": "state"}, {"do": "stop"}]
    for bad in (b"[]\n", b"{\n", b"\xff\n", b"[" * 100_000 + b"\n", b" " * (MAX_LINE_BYTES + 1)):
        with pytest.raises(ManycoreError):
            LineBuffer().take(bad)


def test_the_log_of_a_node_is_one_file(tmp_path: Path) -> None:
    assert log_path(tmp_path, "/a/b").name == "a.b.log"
    assert os.fspath(log_path(tmp_path, "(bridge inward)")).endswith("(bridge inward).log")


def test_no_other_user_can_write_what_a_run_writes(state: Path) -> None:
    before = os.umask(0)
    try:
        with new_run("platform", {"nodes": ["a"]}, joins=False) as own:
            LogFile(own.directory.logs, "a", 4000).write("x")
            modes = {
                str(path.relative_to(state)): path.stat().st_mode & 0o777
                for path in (state, *state.rglob("*"))
            }
    finally:
        os.umask(before)
    assert {name for name, mode in modes.items() if mode & 0o077} == set()
    assert "runs/platform/1/run.json" in modes
    assert "runs/platform/1/log/a.log" in modes


def use_of_runs() -> list[Callable[[], object]]:
    return [
        lambda: new_run("platform", {}, joins=False).__enter__(),
        lambda: runs_of("platform"),
        all_runs,
        remove_ended,
    ]


def assert_advised(refusal: ManycoreError, advice: str, use: Callable[[], object]) -> None:
    """Check what a refusal advises; run it if it is a command, and use runs again."""
    assert f"; {advice}" in str(refusal)
    if quoted(str(refusal)):
        run_quoted(str(refusal), advice.lstrip("`"))
        use()


@pytest.mark.parametrize("use", range(4))
@pytest.mark.parametrize("place", [STATE, f"{STATE}/runs/platform"])
@pytest.mark.parametrize(
    ("mode", "owner", "group", "advice"),
    [
        (0o777, -1, -1, "`chmod 700 "),
        (0o770, -1, 12345, "`chmod 700 "),
        (0o700, 12345, -1, "choose another MANYCORE_STATE"),
    ],
)
def test_directories_of_other_users_are_refused(
    state: Path,
    tmp_path: Path,
    use: int,
    place: str,
    mode: int,
    owner: int,
    group: int,
    advice: str,
) -> None:
    directory = tmp_path / place
    directory.mkdir(0o700, parents=True)
    directory.chmod(mode)
    change_owner(directory, owner, group)
    with pytest.raises(ManycoreError) as refused:
        use_of_runs()[use]()
    assert f"{place}: expected a directory of this user" in str(refused.value)
    assert list(state.rglob("run.json")) == []
    assert_advised(refused.value, advice, use_of_runs()[use])


@pytest.mark.parametrize("use", range(4))
def test_a_directory_for_all_users_is_not_to_be_closed(
    state: Path, use: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    state.mkdir()
    state.chmod(0o1777)
    with pytest.raises(ManycoreError, match="`, and choose that as MANYCORE_STATE") as refused:
        use_of_runs()[use]()
    assert list(state.iterdir()) == []
    monkeypatch.setenv("MANYCORE_STATE", str(state / "manycore"))
    assert_advised(refused.value, "`mkdir -p -m 700 ", use_of_runs()[use])


@pytest.mark.parametrize("use", range(4))
@pytest.mark.parametrize("exists", [True, False])
@pytest.mark.parametrize(
    ("mode", "owner", "group", "advice"),
    [
        (0o777, -1, -1, "`chmod go-w "),
        (0o770, -1, 12345, "`chmod go-w "),
        (0o700, 12345, -1, "choose another MANYCORE_STATE"),
        (0o1777, 12345, -1, "choose another MANYCORE_STATE"),
    ],
)
def test_the_directory_above_is_refused_if_others_can_replace_what_is_in_it(
    state: Path,
    tmp_path: Path,
    use: int,
    exists: bool,
    mode: int,
    owner: int,
    group: int,
    advice: str,
) -> None:
    if exists:
        state.mkdir(0o700)
    tmp_path.chmod(mode)
    change_owner(tmp_path, owner, group)
    with pytest.raises(ManycoreError) as refused:
        use_of_runs()[use]()
    assert f"{tmp_path}: expected a directory in which no other user can" in str(refused.value)
    assert list(tmp_path.iterdir()) == ([state] if exists else [])
    assert_advised(refused.value, advice, use_of_runs()[use])


def test_a_directory_for_all_users_may_hold_that_of_runs(state: Path, tmp_path: Path) -> None:
    tmp_path.chmod(0o1777)
    with new_run("platform", {}, joins=False):
        assert len(runs_of("platform")) == 1


def test_the_group_of_this_user_alone_may_write(state: Path, tmp_path: Path) -> None:
    """Such groups come with umask 002."""
    user = pwd.getpwuid(os.geteuid())
    group = grp.getgrgid(user.pw_gid)
    if group.gr_name != user.pw_name or set(group.gr_mem) - {user.pw_name}:
        pytest.skip("this user has no group of its own")
    state.mkdir()
    for directory in (tmp_path, state):
        os.chown(directory, -1, group.gr_gid)
        directory.chmod(0o775)
    with new_run("platform", {}, joins=False):
        assert len(runs_of("platform")) == 1


def change_owner(directory: Path, owner: int, group: int) -> None:
    """Give a directory to another user or group; -1 leaves them."""
    if (owner, group) != (-1, -1) and os.geteuid() != 0:
        pytest.skip("needs root")
    os.chown(directory, owner, group)


@pytest.mark.parametrize("use", range(4))
def test_the_directory_of_all_runs_is_no_link(state: Path, tmp_path: Path, use: int) -> None:
    (tmp_path / "elsewhere").mkdir(0o700)
    state.symlink_to(tmp_path / "elsewhere")
    with pytest.raises(ManycoreError, match="found a link, ") as refused:
        use_of_runs()[use]()
    assert list((tmp_path / "elsewhere").iterdir()) == []
    assert_advised(refused.value, "`rm ", use_of_runs()[use])


def test_links_between_runs_are_not_followed(state: Path, tmp_path: Path) -> None:
    (tmp_path / "elsewhere" / "1").mkdir(0o700, parents=True)
    (state / "runs").mkdir(parents=True)
    (state / "runs" / "platform").symlink_to(tmp_path / "elsewhere")
    assert all_runs() == []
    with pytest.raises(ManycoreError, match="expected a directory of this user"):
        runs_of("platform")
    assert remove_ended() == []
    assert (tmp_path / "elsewhere" / "1").exists()
