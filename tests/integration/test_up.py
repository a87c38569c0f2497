# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs in the background: up, ps, logs, restart and stop, also after kills."""

from __future__ import annotations

import json
import os
import shlex
import signal
import stat
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.errors import EXIT_BAD_INPUT
from rmw_manycore_py.launch.runs.directory import RunDirectory, runs_of
from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.peers.programs import run_manycore
from support.processes.background import background_runs
from support.processes.commands import manycore_command, peer_command
from support.processes.platforms import leftovers
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore up is about rmw_manycore"),
]

TALKER = "{cluster: 1, core: 1, module: rmw_manycore_py.examples.talker}"
LISTENER = "{cluster: 2, core: 1, module: rmw_manycore_py.examples.listener}"
SLEEPER = "{cluster: 1, core: 3, command: [sleep, '1000'], ros_arguments: false}"


def plain(code: str, **more: Any) -> str:
    """Return the section of a plain Python program, which is no ROS node."""
    command = [sys.executable, "-uc", code]
    section = {"cluster": 1, "core": 2, "command": command, "ros_arguments": False, **more}
    return json.dumps(section)


def write(directory: Path, name: str = "map.yaml", **nodes: str) -> Path:
    path = directory / name
    path.write_text("nodes:\n" + "".join(f"  {name}: {node}\n" for name, node in nodes.items()))
    return path


@pytest.fixture
def manycore(start, platform: str) -> Iterator[Callable[..., Program]]:
    with background_runs(start, platform) as call:
        yield call


def the_run(platform: str) -> RunDirectory:
    (run,) = runs_of(platform)
    return run


@pytest.mark.parametrize("closed", [">&-", "<&- >&- 2>&-"])
def test_a_run_starts_without_standard_streams(manycore, start, tmp_path, platform, closed) -> None:
    checks = manycore_command("map", "check", "talker_listener")  # a child reads its launch file
    starts = manycore_command("up", "-d", write(tmp_path, talker=TALKER))
    for command in (checks, starts):
        program = start(["sh", "-c", f"{shlex.join(map(str, command))} {closed}"])
        assert program.wait() == 0, program
    assert [node["state"] for node in states(manycore, platform).values()] == ["running"]


def states(manycore: Any, platform: str) -> dict[str, dict[str, Any]]:
    runs = json.loads(manycore("ps", "--platform", platform, "--json").output)
    return {node["name"]: node for run in runs for node in run["nodes"]}


def test_a_run_goes_on_in_the_background(manycore, start, tmp_path, platform) -> None:
    up = manycore("up", "-d", write(tmp_path, talker=TALKER, listener=LISTENER))
    assert "manycore | in the background: manycore logs -f; manycore stop" in up.lines
    assert {n["state"] for n in states(manycore, platform).values()} == {"running"}
    follower = start(manycore_command("logs", "-f", "listener"))
    follower.wait_for(r"^listener \| .*I heard: 'Hello World")
    last = manycore("logs", "--tail", "1", "listener").lines[-1]
    number = int(last.rpartition(" ")[2].strip("'"))  # only after the follower has begun
    follower.wait_for(rf"I heard: 'Hello World: {number + 2}'$")
    stopped = manycore("stop")
    assert "manycore | talker finished: stopped" in stopped.lines
    assert follower.wait() == 0
    assert f"the run of platform {platform} has ended" in follower.lines[-1]
    assert not any("talker]" in line for line in follower.lines)
    assert leftovers(platform) == []
    assert "Publishing: 'Hello World: 1'" in manycore("logs", "talker").output
    assert "is stopped: nothing runs on it" in manycore("stop").output


def test_errors_of_a_mapfile_come_before_it_is_in_the_background(manycore, tmp_path) -> None:
    mapfile = write(tmp_path, bad="{cluster: 1, module: no_such_module}")
    assert "no_such_module" in manycore("up", "-d", mapfile, status=EXIT_BAD_INPUT).output
    bad = write(tmp_path, bad=plain("", core=2))
    manycore("up", "-d", bad, "--node", "none", status=EXIT_BAD_INPUT)


def test_what_cannot_be_started_fails_up(manycore, tmp_path, platform) -> None:
    program = tmp_path / "program"
    program.write_bytes(b"\x7fELF of another machine")
    program.chmod(0o755)
    bad = f"{{cluster: 1, core: 1, command: ['{program}'], ros_arguments: false}}"
    up = manycore("up", "-d", write(tmp_path, sleeper=SLEEPER, bad=bad), status=1)
    assert "bad failed: could not be started: Exec format error" in up.output
    assert not the_run(platform).is_alive


def test_a_node_may_be_called_as_the_run_is(manycore, tmp_path) -> None:
    command = "command: [echo, its line], ros_arguments: false"
    run = manycore("run", write(tmp_path, manycore=f"{{cluster: 1, core: 1, {command}}}"))
    assert run.lines.count("manycore | its line") == 1
    logs = manycore("logs").lines
    assert logs.count("manycore | its line") == 1
    assert len([line for line in logs if "started: cluster 1 core 1" in line]) == 1
    assert manycore("logs", "--no-prefix", "manycore").lines == ["its line"]


def test_a_platform_is_up_once(manycore, tmp_path, platform) -> None:
    mapfile = write(tmp_path, sleeper=SLEEPER)
    manycore("up", "-d", mapfile)
    for verb in (("up",), ("up", "-d", "--node", "sleeper"), ("run",)):
        second = manycore(*verb, mapfile, status=1)
        pid = the_run(platform).info["pid"]
        assert f"platform '{platform}' is running already: {mapfile}, pid {pid}" in second.output
    assert states(manycore, platform)["sleeper"]["state"] == "running"
    manycore("stop")
    manycore("up", "-d", mapfile)
    manycore("stop")


def test_nodes_are_stopped_and_restarted_one_by_one(manycore, tmp_path, platform) -> None:
    endless = SLEEPER.replace("core: 3", "core: 2, respawn: {delay: 0}")
    manycore("up", "-d", write(tmp_path, one=endless, other=SLEEPER))
    before = states(manycore, platform)
    manycore("stop", "one", "other")
    held = states(manycore, platform)
    assert {n["state"] for n in held.values()} == {"finished"}, "they are held, not respawned"
    manycore("restart", "/one")
    after = states(manycore, platform)
    assert (after["one"]["state"], after["other"]["state"]) == ("running", "finished")
    manycore("restart")
    last = states(manycore, platform)
    pids = [row[name]["pid"] for row in (before, after, last) for name in ("one", "other")]
    assert len(set(pids)) == len(pids), "each start is a process of its own"
    assert last["one"]["respawns"] == 0
    unknown = manycore("restart", "onne", status=EXIT_BAD_INPUT)
    assert "no node 'onne' in this run; did you mean 'one'?" in unknown.output
    manycore("stop")


def restart_patiently(node: str) -> None:
    """Restart a node and watch it for as long as a busy machine may take to run it."""
    from rmw_manycore_py.cli.common import node_watch

    node_watch.LOOK_S = TIMEOUT_S
    run_manycore("restart", node)


def test_a_node_that_ends_at_once_fails_its_restart(manycore, start, tmp_path, platform) -> None:
    code = "echo no luck; exit 7"
    bad = f"{{cluster: 1, core: 2, command: [sh, -c, '{code}'], ros_arguments: false}}"
    manycore("up", "-d", write(tmp_path, bad=bad, sleeper=SLEEPER))
    wait_until(lambda: states(manycore, platform)["bad"]["state"] == "failed", "it has ended once")
    restart = start(peer_command(restart_patiently, "bad"))
    assert restart.wait() == 1
    assert "manycore | bad failed: exit status 7" in restart.lines
    assert "    no luck" in restart.lines
    assert states(manycore, platform)["bad"]["exit_status"] == 7
    manycore("stop", status=1)
    logs = manycore("logs", "--no-prefix", "bad")
    assert logs.lines == ["no luck", "no luck"], "also those of a node that has died are kept"


def test_respawn_has_a_delay_and_a_limit(manycore, start, tmp_path, platform) -> None:
    code = f"open({str(tmp_path / 'tries')!r}, 'a').write('x'); raise SystemExit(3)"
    short = plain(code, respawn={"delay": 0.1, "max_retries": 2})
    never = plain(code, core=4, respawn=False)
    run = start(manycore_command("run", write(tmp_path, short=short, never=never), "--json"))
    assert run.wait() == 1
    assert (tmp_path / "tries").read_text() == "x" * 4
    again = [line for line in run.lines if '"restarting", "node": "short"' in line]
    assert len(again) == 2


def test_a_node_that_is_respawned_ends_the_run_with_its_last_end(start, tmp_path, platform) -> None:
    code = f"open({str(tmp_path / 'tries')!r}, 'a').write('x'); raise SystemExit(3)"
    last = plain(code, respawn={"delay": 0.1, "max_retries": 2}, ends_run=True)
    run = start(manycore_command("run", write(tmp_path, last=last, sleeper=SLEEPER), "--json"))
    assert run.wait() == 1
    assert (tmp_path / "tries").read_text() == "xxx"
    assert sum('"last has ended"' in line for line in run.lines) == 1


def test_a_supervisor_that_is_killed(manycore, start, tmp_path, platform) -> None:
    manycore("up", "-d", write(tmp_path, talker=TALKER))
    follower = start(manycore_command("logs", "-f"))
    follower.wait_for("Hello World")
    node = states(manycore, platform)["talker"]["pid"]
    os.kill(the_run(platform).info["pid"], signal.SIGKILL)
    assert follower.wait() == 0
    wait_until(lambda: not Path(f"/proc/{node}").exists(), "its node dies with it")
    assert "Hello World: 1" in manycore("logs", "talker").output
    (killed,) = manycore("ps", "--platform", platform).lines
    assert killed.startswith(
        f"platform {platform}: the run of {tmp_path / 'map.yaml'} was killed at"
    )
    assert "is stopped" in manycore("stop").output
    shown = manycore("ps", "--platform", platform).lines
    assert shown == ["no run of `manycore run` or `manycore up`"]
    assert "is run by no `manycore run`" in manycore("restart", "talker", status=1).output
    wait_until(lambda: not leftovers(platform), "the receive thread has cleaned up")
    manycore("up", "-d", write(tmp_path, sleeper=SLEEPER))
    manycore("stop")


def test_what_was_started_by_hand_is_named_and_not_stopped(manycore, start, platform) -> None:
    talker = start([sys.executable, "-m", "rmw_manycore_py.examples.talker"])
    talker.wait_for("Hello World")
    stop = manycore("stop", status=1)
    assert f"({talker.pid}), started by other means" in stop.output
    assert talker.stop() == 0


def test_ctrl_c_while_it_comes_up_stops_what_was_started(start, tmp_path, platform) -> None:
    slow = "import signal, time; signal.signal(signal.SIGTERM, lambda *_: 0); time.sleep(1000)"
    nodes = {f"n{i}": plain(slow, core=i) for i in range(1, 15)}
    up = start(manycore_command("up", "-d", write(tmp_path, **nodes)))
    up.wait_for("n1 started")
    # The others: it was up before the signal arrived, and had ended, or its interpreter was ending.
    assert up.stop() in (130, 0, -signal.SIGINT)
    for run in runs_of(platform):
        if run.is_alive:
            stop = start(manycore_command("stop", "--now"))
            stop.wait()
    assert leftovers(platform) == []


def test_runs_join_a_platform(manycore, start, tmp_path, platform) -> None:
    assert (
        "there is no platform"
        in manycore("up", "-d", "--join", write(tmp_path, talker=TALKER), status=1).output
    )
    manycore("up", "-d", write(tmp_path, talker=TALKER))
    taken = write(tmp_path, "taken.yaml", listener=LISTENER.replace("2,", "1,", 1))
    wait_until(lambda: "talker" in manycore("node", "list").output, "the talker has come up")
    refused = manycore("up", "-d", "--join", taken, status=EXIT_BAD_INPUT)
    assert "expected a core that no node on the platform has" in refused.output
    further = "{cluster: 1, module: rmw_manycore_py.examples.listener}"
    joined = start(
        manycore_command(
            *("run", "--join", "--node", "listener"),
            write(tmp_path, "more.yaml", listener=further, talker=TALKER),
        )
    )
    joined.wait_for(r"^listener +1 +2 ")
    joined.wait_for("I heard: 'Hello World")
    assert set(states(manycore, platform)) == {"talker", "listener"}
    manycore("restart", "listener")
    joined.skip_output()  # of the one before
    joined.wait_for("I heard: 'Hello World")
    manycore("stop")
    assert joined.wait() == 0
    assert leftovers(platform) == []


def test_files_of_a_run_are_private(manycore, tmp_path, platform) -> None:
    manycore("up", "-d", write(tmp_path, sleeper=SLEEPER))
    run = the_run(platform)
    assert stat.S_IMODE((run.path / "control").stat().st_mode) == 0o600
    assert {stat.S_IMODE(p.stat().st_mode) for p in (run.path, run.path.parent)} == {0o700}
    manycore("stop")
    run.path.parent.chmod(0o755)
    refused = manycore("run", write(tmp_path, sleeper=SLEEPER), status=1)
    assert f"chmod 700 {run.path.parent}" in refused.output
    run.path.parent.chmod(0o700)


def test_a_state_directory_that_cannot_be_had(start, tmp_path, platform) -> None:
    file = tmp_path / "file"
    file.touch()
    quick = write(tmp_path, quick=plain("print('hello')"))
    run = start(manycore_command("run", quick), MANYCORE_STATE=str(file))
    assert run.wait() == 0
    assert "no logs are kept" in run.output
    assert "quick    | hello" in run.lines
    up = start(manycore_command("up", "-d", quick), MANYCORE_STATE=str(file))
    assert up.wait() == 1
    assert "set MANYCORE_STATE to a directory that can be written to" in up.output
