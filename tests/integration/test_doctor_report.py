# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore doctor --report`: complete on a running platform, and written when all is broken."""

from __future__ import annotations

import json
import os
import shutil
import socket
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest
import yaml

from support import IS_MANYCORE, MAPFILES
from support.peers.programs import forked_example
from support.processes.commands import manycore_command
from support.processes.platforms import PLATFORMS

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

SECTIONS = [
    *("versions", "machine", "limits", "kernel settings", "environment", "checks"),
    *("platforms", "bridges", "mapfiles", "log"),
]

MAX_LINES = 100  # of a platform with two nodes
# A Python that runs a script without these packages, and so do the programs that it starts.
WITHOUT_PACKAGES = f"""#!{sys.executable}
import runpy
import sys
class Missing:
    def find_spec(self, name, path=None, target=None):
        if name in ("rmw_manycore_bridge", "pydantic", "rclpy"):
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)
sys.meta_path.insert(0, Missing())
sys.executable = __file__
del sys.argv[0]
runpy.run_path(sys.argv[0], run_name="__main__")
"""


@pytest.fixture
def report(start, tmp_path):
    """Return a function that makes a report in JSON and returns its text and its sections."""

    def make(*words: str | Path, python: Sequence[Path] = (), **variables: str) -> tuple[str, dict]:
        file = tmp_path / "report.json"
        command = manycore_command("doctor", "--report", file, *words)
        program = start([*python, *command], **variables)
        assert program.wait() == 0, program
        text = file.read_text()
        sections = json.loads(text)
        assert list(sections) == SECTIONS
        return text, sections

    return make


def row_of(sections: dict, platform: str) -> dict:
    return next(row for row in sections["platforms"] if row["name"] == platform)


def own_mapfile(directory: Path, name: str) -> Path:
    """Return the path of a copy of talker_listener.yaml that no other test runs."""
    launch_file = "talker_listener.launch.xml"
    for part in ("mapfiles", "launch_scripts"):
        (directory / part).mkdir()
    shutil.copy(MAPFILES.parent / "launch_scripts" / launch_file, directory / "launch_scripts")
    path = directory / "mapfiles" / f"{name}.yaml"
    return Path(shutil.copy(MAPFILES / "talker_listener.yaml", path))


def test_a_running_platform(start, platform, report, tmp_path):
    """What is of this platform has names of its own: the report is of those of other tests, too."""
    home = tmp_path / "home"
    (home / ".ros" / "log").mkdir(parents=True)
    log = home / ".ros" / "log" / "python3_1_2.log"
    secret = f"secret-of-{platform}"
    log.write_text(f"[INFO] [1.0] [n]: I heard: '{secret}'\n[ERROR] [2.0] [n]: no route\n")
    run = start(manycore_command("run", own_mapfile(tmp_path, platform), "--json"))
    run.wait_for("I heard")
    variables = {"HOME": str(home), "MY_TOKEN": secret, "ROS_SOMETHING": f"{home}/x"}
    text, sections = report(**variables)
    row = row_of(sections, platform)
    nodes = {node: p for p in row["processes"] for node in p["nodes"]}
    assert {"/talker", "/listener"} <= nodes.keys()
    loaded = nodes["/talker"]["middleware loaded"]
    assert any(file.endswith("librmw_manycore.so") for file in loaded.split(", "))
    (chatter,) = (e for e in row["endpoints"] if e.startswith("publisher of /chatter "))
    assert chatter.startswith(
        "publisher of /chatter (std_msgs/msg/String) by /talker: reliable volatile keep_last 10; "
        "dsm, matched 1, messages "
    )
    assert row["endpoints of services"] > 0
    assert len(yaml.safe_dump(row).splitlines()) < MAX_LINES
    mapfile = next(r for r in sections["mapfiles"] if r["file"] == f"{platform}.yaml")
    assert mapfile["content"]["launch_path"] == "talker_listener.launch.xml"
    assert sections["environment"]["ROS_SOMETHING"] == "~/x"
    assert sections["log"] == [{"file": log.name, "lines": ["[ERROR] [2.0] [n]: no route"]}]
    for private in ("Hello World", secret, "MY_TOKEN", str(tmp_path)):
        assert private not in text
    assert run.stop() == 0


def test_a_damaged_platform_hides_no_other(start, platform, report):
    damaged = PLATFORMS / f"{platform}-damaged"
    start(forked_example("talker")).wait_for("Publishing")
    damaged.mkdir(mode=0o700)
    try:
        (damaged / "alive").touch(mode=0o600)
        (damaged / "registry").write_bytes(os.urandom(4096))
        _, sections = report()
    finally:
        shutil.rmtree(damaged)
    assert "registry" in row_of(sections, damaged.name)["not available"]
    assert "/talker" in row_of(sections, platform)["processes"][0]["nodes"]


def test_with_packages_missing_each_section_says_so(report, tmp_path):
    python = tmp_path / "python"
    python.write_text(WITHOUT_PACKAGES)
    python.chmod(0o755)
    _, sections = report("--mapfile", "talker_listener", python=[python])
    assert "No module named 'pydantic'" in sections["mapfiles"]
    assert "No module named 'rmw_manycore_bridge'" in sections["bridges"]
    checks = {row["subject"]: row for row in sections["checks"]}
    assert "rclpy does not start" in checks["substitution"]["found"]
    assert sections["versions"]["rmw_manycore"]


def test_it_is_printed_without_names(start, tmp_path):
    secret = tmp_path / "map.yaml"
    secret.write_text(
        f"nodes:\n  n: {{cluster: 1, command: [/opt/{socket.gethostname()}/prog, --key=hunter2], "
        "env: {A: hunter2, ROS_X: shown}, parameters: {p: hunter2}}\n"
    )
    words = manycore_command("doctor", "--report", "-", "--mapfile", secret)
    program = start(words, HOME=str(tmp_path))
    assert program.wait() == 0, program
    text = program.output
    assert text.startswith("# Report of manycore doctor.")
    (row,) = yaml.safe_load(text)["mapfiles"]
    assert row["file"] == "map.yaml"
    assert row["content"]["nodes"]["n"] == {
        "cluster": 1,
        "command": ["prog"],
        "env": {"A": "(not shown)", "ROS_X": "shown"},
        "parameters": {"p": "(not shown)"},
    }
    assert "hunter2" not in text
    assert str(tmp_path) not in text


def test_a_file_that_cannot_be_written_is_one_line(start, tmp_path):
    program = start(manycore_command("doctor", "--report", tmp_path / "none" / "report.txt"))
    assert program.wait() == 1
    assert program.lines == [
        f"manycore: {tmp_path}/none/report.txt: cannot be written: No such file or directory"
    ]
