# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a report omits."""

from __future__ import annotations

import getpass
import socket
from pathlib import Path

import pytest

from rmw_manycore_py.cli.doctor.report.environment import environment, short_path
from rmw_manycore_py.cli.doctor.report.mapfiles import mapfile_of
from rmw_manycore_py.cli.doctor.report.privacy import anonymous

pytestmark = pytest.mark.unit


@pytest.fixture(autouse=True)
def alice(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Path, "home", lambda: Path("/home/alice"))
    monkeypatch.setattr(getpass, "getuser", lambda: "alice")
    monkeypatch.setattr(socket, "gethostname", lambda: "vm.example.org")


@pytest.mark.parametrize(
    ("text", "left"),
    [
        ("/home/alice/ws/x.py", "~/ws/x.py"),
        ("/home/alice", "~"),
        ("/home/alicette/x", "/home/alicette/x"),
        ("/data/alice/x", "/data/<user>/x"),
        ("of alice on vm.example.org", "of <user> on <host>"),
        ("of vm", "of <host>"),
        ("/malice vmware", "/malice vmware"),
    ],
)
def test_names_are_left_out(text: str, left: str) -> None:
    assert anonymous({"vm.x": [text, 1, None]}, keys=False) == {"vm.x": [left, 1, None]}
    assert anonymous({text: True}, keys=True) == {left: True}


def test_other_variables_are_not_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("AWS_SECRET_ACCESS_KEY", "s")
    monkeypatch.setenv("XROS_DOMAIN_ID", "s")
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_manycore")
    monkeypatch.setenv("LD_LIBRARY_PATH", "/a/b/c/d/e:/x")
    shown = environment()
    assert shown["RMW_IMPLEMENTATION"] == "rmw_manycore"
    assert shown["LD_LIBRARY_PATH"] == ".../c/d/e:/x"
    assert not {"AWS_SECRET_ACCESS_KEY", "XROS_DOMAIN_ID", "HOME", "PATH"} & shown.keys()


def test_short_paths_stay() -> None:
    assert short_path("/lib/x.so") == "/lib/x.so"


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (["/x/bin/manycore", "run", "a.yaml"], "a.yaml"),
        (["/x/python3", "/x/bin/manycore", "run", "--duration", "3", "a.yaml", ""], "a.yaml"),
        (["/x/python3", "/x/bin/manycore", "run", "--duration=3", "--json", "a.yaml"], "a.yaml"),
        (["/x/python3", "/x/bin/manycore", "run"], None),
        (["/x/python3", "/x/bin/manycore", "map", "run"], None),
        (["vi", "manycore.yaml", "run"], None),
        ([""], None),
    ],
)
def test_the_mapfile_of_a_command_line(words: list[str], name: str | None) -> None:
    assert mapfile_of(words) == name
