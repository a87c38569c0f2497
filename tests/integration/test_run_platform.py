# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore run` with real nodes: the platform it configures, and what is left afterwards."""

from __future__ import annotations

import json
import re
import shlex
import signal
from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.errors import EXIT_BAD_INPUT
from support import IS_MANYCORE, MAPFILES, wait_until
from support.processes.commands import manycore_command
from support.processes.inspection import kill_all
from support.processes.platforms import leftovers
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore"),
]

TALKER_LISTENER = MAPFILES / "talker_listener.yaml"
TALKER = "{cluster: 1, core: 1, module: rmw_manycore_py.examples.talker}"
HEARD = r"listener\].*I heard: 'Hello World"


def events(program: Program, kind: str) -> list[dict[str, Any]]:
    lines = (json.loads(line) for line in program.lines if line.startswith("{"))
    return [event for event in lines if event["event"] == kind]


def write_mapfile(directory: Path, **nodes: str) -> Path:
    path = directory / "map.yaml"
    path.write_text("nodes:\n" + "".join(f"  {name}: {node}\n" for name, node in nodes.items()))
    return path


def test_people_see_the_table_the_prefixes_and_the_end(start, platform) -> None:
    run = start(manycore_command("run", TALKER_LISTENER))
    run.wait_for(rf"^platform {platform} \(coolidge\): 5 clusters x 16 cores, SMEM 4 MiB each$")
    run.wait_for(r"^node +cluster +core +host CPU$")
    run.wait_for(r"^talker +1 +1 +\d+$")
    run.wait_for(rf"^listener \| .*{HEARD}")
    assert run.stop() == 0
    run.wait_for(r"^manycore \| stopping: SIGINT$")
    assert {"manycore | talker finished: stopped", "manycore | listener finished: stopped"} <= set(
        run.lines
    )
    assert leftovers(platform) == []


@pytest.mark.parametrize("reader", ["grep -q 'Hello World: 2'", "true"])
def test_a_reader_that_leaves_ends_the_run_with_success(start, platform, reader) -> None:
    run = shlex.join(map(str, manycore_command("run", TALKER_LISTENER, "--json")))
    pipeline = start(["bash", "-c", f"set -o pipefail; {run} | {reader}"])
    assert pipeline.wait() == 0, pipeline
    assert not pipeline.lines
    assert leftovers(platform) == []


def test_a_reader_that_leaves_does_not_hide_a_failure(start, tmp_path) -> None:
    code = "import os; print('no luck', flush=True); os._exit(7)"
    bad = f'{{cluster: 1, core: 1, command: [python3, -c, "{code}"], ros_arguments: false}}'
    mapfile = write_mapfile(tmp_path, bad=bad, talker=TALKER)
    run = shlex.join(map(str, manycore_command("run", mapfile)))
    pipeline = start(["bash", "-c", f"set -o pipefail; {run} | grep -q 'bad failed'"])
    assert pipeline.wait() == 1, pipeline


def test_a_node_that_fails_is_shown_with_its_reason(start, tmp_path, platform) -> None:
    code = "import sys; print('no luck'); sys.exit(7)"
    mapfile = write_mapfile(
        tmp_path,
        bad=f'{{cluster: 1, core: 1, command: [python3, -c, "{code}"], ros_arguments: false}}',
    )
    run = start(manycore_command("run", mapfile))
    assert run.wait() == 1
    assert "manycore | bad failed: exit status 7" in run.lines
    assert run.lines[-2:] == ["bad failed: exit status 7", "    no luck"]
    assert leftovers(platform) == []


def test_a_message_type_that_is_not_installed(start, tmp_path, platform) -> None:
    mapfile = write_mapfile(tmp_path, node="{cluster: 1, script: node.py}")
    source = tmp_path / "node.py"
    source.write_text("from no_such_msgs.msg import Thing\n")
    run = start(manycore_command("run", mapfile))
    assert run.wait() == EXIT_BAD_INPUT
    assert "no_such_msgs/msg/Thing to be installed, which node.py:1 imports" in run.output
    assert leftovers(platform) == []


def test_a_message_type_that_is_missed_later(start, tmp_path, platform) -> None:
    """The imports of a source are unknown before it runs."""
    mapfile = write_mapfile(tmp_path, node="{cluster: 1, script: node.py}")
    source = tmp_path / "node.py"
    source.write_text("if True:\n    from no_such_msgs.msg import Thing\n")
    run = start(manycore_command("run", mapfile))
    assert run.wait() == 1
    assert "ModuleNotFoundError: No module named 'no_such_msgs'" in run.output
    assert leftovers(platform) == []


def test_a_mapfile_with_an_unknown_program_starts_nothing(start, tmp_path, platform) -> None:
    bad = "{cluster: 1, core: 2, module: no_such_module}"
    run = start(manycore_command("run", write_mapfile(tmp_path, talker=TALKER, bad=bad), "--json"))
    assert run.wait() == EXIT_BAD_INPUT
    assert events(run, "started") == []
    assert "no_such_module" in run.output
    assert leftovers(platform) == []


def test_a_platform_runs_once(start, platform) -> None:
    first = start(manycore_command("run", TALKER_LISTENER))
    first.wait_for(HEARD)
    second = start(manycore_command("run", TALKER_LISTENER))
    assert second.wait() == 1
    assert re.search(
        f"platform '{platform}' is running already: .*talker_listener.yaml, pid \\d+; "
        f"`manycore stop --platform {platform}` stops it",
        second.output,
    )
    first.wait_for(HEARD)
    assert first.stop() == 0


def test_after_the_runner_was_killed_the_platform_starts_again(start, platform) -> None:
    killed = start(manycore_command("run", TALKER_LISTENER, "--json"))
    killed.wait_for(HEARD)
    killed.signal(signal.SIGKILL)
    wait_until(lambda: not leftovers(platform), "the platform goes when its nodes are killed")
    again = start(manycore_command("run", TALKER_LISTENER, "--json"))
    again.wait_for(HEARD)
    assert again.stop() == 0


def test_everything_killed_at_once_is_cleaned_by_the_next_start(start, platform) -> None:
    killed = start(manycore_command("run", TALKER_LISTENER, "--json"))
    killed.wait_for(HEARD)
    kill_all(platform)
    assert leftovers(platform)
    again = start(manycore_command("run", TALKER_LISTENER, "--json"))
    again.wait_for(HEARD)
    assert again.stop() == 0


def test_a_node_from_outside_keeps_the_platform_and_is_named(start, platform) -> None:
    run = start(manycore_command("run", TALKER_LISTENER, "--json"))
    run.wait_for(HEARD)
    echo = start(manycore_command("topic", "echo", "/chatter"))
    echo.wait_for("^data: ")
    assert run.stop() == 0
    assert f"({echo.pid})" in events(run, "notice")[-1]["text"]
    echo.stop()


def test_duration_counts_from_the_last_start(start, tmp_path, platform) -> None:
    mapfile = write_mapfile(
        tmp_path,
        one="{cluster: 1, core: 1, command: [sleep, '1000'], ros_arguments: false}",
        two="{cluster: 2, core: 1, command: [sleep, '1000'], ros_arguments: false}",
    )
    run = start(manycore_command("run", mapfile, "--duration", "1", "--json"))
    assert run.wait() == 0
    assert events(run, "stopping")[0]["reason"] == "the duration is over"
    assert events(run, "finished") == [{"event": "finished", "failed": [], "exit_status": 0}]
