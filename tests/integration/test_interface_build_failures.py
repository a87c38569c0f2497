# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Builds that fail, are killed, or run at the same time; and removals."""

from __future__ import annotations

import fcntl
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from support import IS_MANYCORE, wait_until
from support.installs.building import TINY, interface, write_definitions
from support.installs.installing import READ_ONLY
from support.processes.commands import manycore_command
from support.processes.own_shm import can_mount
from support.sources.advice import quoted, run_quoted

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

BASE = {"base_msgs/msg/Base.msg": "int32 number\n"}
USER = {"user_msgs/msg/User.msg": "base_msgs/Base base\n"}


@pytest.fixture
def env(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, str]:
    monkeypatch.setenv("MANYCORE_INTERFACES", str(tmp_path / "built"))
    return dict(os.environ)


@pytest.fixture
def sources(tmp_path: Path) -> Path:
    return tmp_path / "the sources"


def imported(module: str, env: dict[str, str]) -> subprocess.CompletedProcess[str]:
    code = f"import {module}; print({module}.__file__)"
    return subprocess.run(
        [sys.executable, "-c", code], env=env, capture_output=True, text=True, cwd="/"
    )


def test_a_killed_build_leaves_nothing_and_builds_at_once_wait(
    start, env, sources, tmp_path
) -> None:
    write_definitions(sources, {**TINY, **BASE})
    compiler, compiling = tmp_path / "cc", tmp_path / "compiling"
    compiler.write_text(f"#!/bin/sh\necho $$ >>{compiling}\nexec sleep 1000\n")
    compiler.chmod(0o755)
    command = manycore_command("interface", "build", sources / "tiny_msgs")
    build = start(command, CC=str(compiler), CXX=str(compiler))
    wait_until(lambda: compiling.exists() and compiling.read_text(), "it compiles", 300)
    build.signal(signal.SIGKILL)
    build.wait()
    for pid in compiling.read_text().split():
        wait_until(lambda pid=pid: not Path("/proc", pid).exists(), "compilers die with it")
    assert "No module named 'tiny_msgs'" in imported("tiny_msgs", env).stderr
    listed = interface("list", "--built", env=env).stdout
    assert "no packages built" in listed
    check_builds_at_once(start, env, sources, listed.split()[-1])
    assert list(Path(env["MANYCORE_INTERFACES"]).glob("*/building/*")) == []


def check_builds_at_once(start, env: dict[str, str], sources: Path, directory: str) -> None:
    """Build two packages in two processes: each waits while another one builds."""
    with open(f"{directory}/lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        names = ("tiny_msgs", "base_msgs")
        builds = [start(manycore_command("interface", "build", sources / name)) for name in names]
        for build in builds:
            build.wait_for("waiting for another build to finish")
    for build in builds:
        assert build.wait(600) == 0, build
    for name in names:
        assert imported(f"{name}.msg", env).returncode == 0
    only = ("--only", "tiny_msgs/msg/Tiny")
    done = interface("build", sources / "tiny_msgs", *only, env=env)
    assert done.stdout == "tiny_msgs: 1 definition, built before\n"
    assert imported("base_msgs.msg", env).returncode == 0


@pytest.mark.stress  # compiles four packages
def test_a_changed_package_is_built_again_with_those_that_contain_it(env, sources) -> None:
    write_definitions(sources, {**BASE, **USER})
    interface("build", sources, env=env)
    refused = interface("remove", "base_msgs", env=env, status=1)
    assert "package 'user_msgs' needs 'base_msgs': remove it, too" in refused.stderr
    write_definitions(sources, {"base_msgs/msg/Base.msg": "int32 number\nfloat64 more\n"})
    done = interface("build", sources / "base_msgs", env=env)
    assert [line.split(" in ")[0] for line in done.stdout.splitlines()] == [
        "base_msgs: 1 definition",
        "user_msgs: 1 definition",
    ]
    code = "from user_msgs.msg import User; print(User().base.more)"
    assert subprocess.check_output([sys.executable, "-c", code], env=env, cwd="/") == b"0.0\n"
    interface("remove", "base_msgs", "user_msgs", env=env)
    assert "No module named 'user_msgs'" in imported("user_msgs", env).stderr
    assert list(Path(env["MANYCORE_INTERFACES"]).glob("*/store/*")) == []
    gone = interface("remove", "user_msgs", env=env, status=1)
    assert "package 'user_msgs' was not built here; built: none" in gone.stderr


@pytest.mark.stress  # compiles four packages
def test_what_a_newer_package_elsewhere_outdates_is_built_again(
    env, sources, tmp_path, monkeypatch
) -> None:
    write_definitions(sources, {**BASE, **USER})
    interface("build", sources, env=env)
    newer = write_definitions(tmp_path / "newer", {"base_msgs/msg/Base.msg": "float64 number\n"})
    interface("build", newer, env={**env, "MANYCORE_INTERFACES": str(tmp_path / "other")})
    (prefix,) = (tmp_path / "other").glob("*/current")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    monkeypatch.setenv("PYTHONPATH", str(prefix / "python"))
    refused = imported("user_msgs", dict(os.environ))
    doctor = subprocess.run(manycore_command("doctor"), capture_output=True, text=True).stdout
    assert quoted(refused.stderr) == [
        f"manycore interface build '{sources}/user_msgs'",
        "manycore interface remove user_msgs",
    ]
    assert set(quoted(doctor)) > {*quoted(refused.stderr), "manycore interface remove base_msgs"}
    run_quoted(refused.stderr, "manycore interface build")
    assert imported("user_msgs", dict(os.environ)).returncode == 0
    run_quoted(doctor, "manycore interface remove base_msgs")
    doctor = subprocess.run(manycore_command("doctor"), capture_output=True, text=True).stdout
    assert not [command for command in quoted(doctor) if "interface" in command]


def test_a_package_that_does_not_compile_is_named_and_none_is_seen(env, sources) -> None:
    # errno is a macro: the generators accept the name, only the compiler fails.
    odd = {"user_msgs/msg/User.msg": "base_msgs/Base base\nint32 errno\n"}
    write_definitions(sources, {**BASE, **odd})
    failed = interface("build", sources, env=env, status=2)
    file = f"{sources}/user_msgs/msg/User.msg"
    assert f"{file}: expected a definition that can be built" in failed.stderr
    assert "No module named 'base_msgs'" in imported("base_msgs", env).stderr
    write_definitions(sources, USER)
    done = interface("build", sources, env=env)
    assert "base_msgs: 1 definition, built before" in done.stdout
    assert imported("user_msgs.msg", env).returncode == 0


def test_a_generator_that_fails_is_one_line_with_its_reason(env, sources) -> None:
    text = "module odd_msgs { module msg { struct Odd { @default(value=3) short a[3]; }; }; };\n"
    write_definitions(sources, {"odd_msgs/msg/Odd.idl": text})
    failed = interface("build", sources, env=env, status=2)
    file = f"{sources}/odd_msgs/msg/Odd.idl"
    assert f"{file}: expected a definition that can be built, found" in failed.stderr
    assert failed.stderr.endswith("error: malformed node or string: 3\n")


def test_definitions_that_are_wrong_are_named_before_anything_is_built(env, sources) -> None:
    write_definitions(sources, {**TINY, "bad_msgs/msg/Bad.msg": "int32 a\nint32 9\n"})
    failed = interface("build", sources, env=env, status=2)
    assert f"{sources}/bad_msgs/msg/Bad.msg:2: expected a field" in failed.stderr
    assert not Path(env["MANYCORE_INTERFACES"]).exists()


def test_without_a_compiler_it_says_what_to_install(env, sources, tmp_path) -> None:
    write_definitions(sources, TINY)
    without = {k: v for k, v in env.items() if k not in ("CC", "CXX")} | {"PATH": str(tmp_path)}
    failed = interface("build", sources, env=without, status=1)
    assert "building interfaces needs a C compiler (cc, gcc, clang in PATH)" in failed.stderr
    failed = interface("build", sources, env={**env, "CXX": "no-such-c++ -O3"}, status=1)
    assert "CXX=no-such-c++: expected a compiler" in failed.stderr


@pytest.mark.skipif(not can_mount(), reason="mounts a file system")
def test_a_home_that_is_read_only_is_an_error(env, sources, tmp_path) -> None:
    write_definitions(sources, TINY)
    home = tmp_path / "home"
    home.mkdir()
    script = f'{READ_ONLY.format(home)} exec "$@"'
    command = manycore_command("interface", "build", sources)
    done = subprocess.run(
        ["unshare", "--mount", "sh", "-c", script, "sh", *map(str, command)],
        env={**env, "MANYCORE_INTERFACES": "", "XDG_DATA_HOME": "", "HOME": str(home)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 1
    assert f"manycore: {home}" in done.stderr
    assert "Read-only file system; set MANYCORE_INTERFACES to a writable directory" in done.stderr
