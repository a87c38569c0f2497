# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fixtures of all tests, and one process for each test of the rmw interface."""

from __future__ import annotations

import gc
import importlib.util
import os
import shutil
import signal
import sys
import tempfile
from collections.abc import Callable, Generator, Iterator
from pathlib import Path
from typing import Any

import pytest

from support import IS_MANYCORE, TESTS, wait_until
from support.peers.client import PeerServers
from support.processes.fast_dds import remove_unfinished_ports
from support.processes.inspection import has_receive_threads
from support.processes.platforms import environment, leftovers, unique_platform
from support.processes.program import Program
from support.session.fork_server import ForkServer, is_inside
from support.session.isolation import Isolation
from support.session.scheduling import begin_with_longest, make_scheduler

PEER_SERVERS = pytest.StashKey[PeerServers]()
PROGRAMS = pytest.StashKey[list[Program]]()
SHOWN_LINES = 40
StartProgram = Callable[..., Program]


def pytest_configure(config: pytest.Config) -> None:
    # Background jobs of a shell ignore SIGINT, and those of nohup SIGHUP; the programs that the
    # tests start would inherit that.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    # Each worker, and each program that a test starts, would compile again all that it imports.
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    sys.dont_write_bytecode = False
    # The wheels of rosidl bring an old parser, which uses deprecated modules.
    config.addinivalue_line("filterwarnings", "ignore:module 'sre_:DeprecationWarning")
    if is_inside():
        config.pluginmanager.register(ForkServer(config))
    else:
        config.stash[PEER_SERVERS] = servers = PeerServers()
        states = tempfile.TemporaryDirectory(prefix="manycore-state-")
        config.add_cleanup(states.cleanup)
        os.environ["MANYCORE_STATE"] = states.name
        config.add_cleanup(servers.end)
        config.pluginmanager.register(Isolation(servers))


def pytest_runtest_setup(item: pytest.Item) -> None:
    needed = {name for mark in item.iter_markers("needs") for name in mark.args}
    if missing := [name for name in sorted(needed) if not _is_installed(name)]:
        pytest.fail(f"missing: {', '.join(missing)}; run scripts/setup.sh tests", pytrace=False)


def _is_installed(name: str) -> bool:
    """Return whether a program or a Python module of this name is installed."""
    return shutil.which(name) is not None or importlib.util.find_spec(name) is not None


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, Any, Any]:
    """Collect without looking for garbage: what is collected stays until the end.

    Nor is it looked at later, by this process or those that it forks.
    """
    gc.disable()
    result = yield
    gc.freeze()
    gc.enable()
    return result


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    begin_with_longest(items)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    return make_scheduler(config, log)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, Any, Any]:
    """Add the output of all programs of the test to a failure; any of them may be the cause."""
    report = yield
    if report.failed:
        for program in item.stash.get(PROGRAMS, []):
            command, *lines = repr(program).splitlines()
            report.sections.append((command, "\n".join(lines[-SHOWN_LINES:])))
    return report


@pytest.fixture
def platform() -> Iterator[str]:
    """Yield the name of the test's platform; afterwards check that nothing of it is left."""
    if is_inside():
        yield os.environ["MANYCORE_PLATFORM"]
        return
    name = unique_platform()
    yield name
    if IS_MANYCORE:
        wait_until(lambda: not leftovers(name), f"{name} leaves nothing in /dev/shm")


@pytest.fixture
def start(platform: str, request: pytest.FixtureRequest) -> Iterator[StartProgram]:
    """Yield a function that starts a program on the test's platform; all end with the test."""
    programs = request.node.stash.setdefault(PROGRAMS, [])
    servers = request.config.stash.get(PEER_SERVERS, None)

    def start_program(
        command: list[str], cluster: int = 1, directory: Path = TESTS, **env: str
    ) -> Program:
        full_env = environment(platform, cluster, **env)
        if servers:
            servers.serve(command, full_env)
        programs.append(Program(command, full_env, directory))
        return programs[-1]

    yield start_program
    if IS_MANYCORE and any(program.is_running() for program in programs):
        wait_until(lambda: has_receive_threads(platform), "receive threads can clean up")
    for program in programs:
        program.kill()
    remove_unfinished_ports()
