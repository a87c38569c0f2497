# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One process per test: a crash fails one test only, and each test joins a new platform."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest

from support import IS_MANYCORE, TESTS, TIMEOUT_S, wait_until
from support.peers.client import PEER, PeerServers
from support.processes.platforms import environment, leftovers, unique_platform
from support.session.fork_server import LARGEST_MESSAGE_BYTES, SOCKET_VARIABLE

MARKER = "rmw"
TEST_RAN = (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED)


class Isolation:
    """Let a fork server run the tests of the rmw interface, and forward its reports."""

    def __init__(self, peers: PeerServers) -> None:
        self._peers = peers
        self._server: _Server | None = None

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> bool | None:
        if not item.get_closest_marker(MARKER):
            return None
        item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
        for report in self._reports(item):
            item.ihook.pytest_runtest_logreport(report=report)
        item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
        return True

    def pytest_sessionfinish(self) -> None:
        self._end_server()

    def _reports(self, item: pytest.Item) -> list[pytest.TestReport]:
        platform = unique_platform()
        if self._server is None:
            self._server = _Server(item.session)
            self._peers.serve([sys.executable, str(PEER)], environment(platform))
        lines, problem = self._server.run(item.nodeid, platform)
        if problem is not None:  # the server may be affected, too
            self._end_server()
        reports = [_to_report(item.config, json.loads(line)) for line in lines]
        if problem is None and not any(report.failed for report in reports):
            problem = _leftover_problem(platform)
        return reports if problem is None else [*reports, _failure(item, problem)]

    def _end_server(self) -> None:
        if self._server is not None:
            self._server.end()
            self._server = None


class _Server:
    """A fork server that has collected the test files of this session."""

    def __init__(self, session: pytest.Session) -> None:
        self._directory = tempfile.TemporaryDirectory()
        self._output = Path(self._directory.name) / "output"
        self._reports = Path(self._directory.name) / "reports"
        tests = [item for item in session.items if item.get_closest_marker(MARKER)]
        files = sorted({str(item.path) for item in tests})
        self._connection, remote = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._connection.settimeout(4 * TIMEOUT_S)
        env = {SOCKET_VARIABLE: str(remote.fileno()), "OPENBLAS_NUM_THREADS": "1"}
        with remote, self._output.open("w") as output:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-m", MARKER, *files],
                env=environment(unique_platform(), **env),
                cwd=TESTS,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                pass_fds=[remote.fileno()],
            )

    def run(self, test: str, platform: str) -> tuple[list[str], str | None]:
        """Return the reports of a test, and what is wrong with its process."""
        self._reports.unlink(missing_ok=True)
        output_start = self._output.stat().st_size
        names = ("MANYCORE_PLATFORM", "ROS_DOMAIN_ID")
        request = {
            "test": test,
            "reports": str(self._reports),
            "environment": {name: environment(platform)[name] for name in names},
        }
        problem = self._wait_for(request)
        lines = self._reports.read_text().splitlines() if self._reports.exists() else []
        if problem is not None:
            output = self._output.read_bytes()[output_start:].decode(errors="replace")
            problem += f":\n{output}"
        return lines, problem

    def _wait_for(self, request: dict[str, Any]) -> str | None:
        """Wait until the requested test has run; return what is wrong with its process."""
        try:
            self._connection.send(json.dumps(request).encode())
            pid = self._receive()
        except (OSError, ValueError):
            return "the fork server has not started the test"
        try:
            return _problem_of(self._receive())
        except TimeoutError:
            os.kill(pid, signal.SIGABRT)  # faulthandler prints the stacks of its threads
            return f"the test hangs: {_problem_of(self._receive())}"

    def _receive(self) -> int:
        return int(self._connection.recv(LARGEST_MESSAGE_BYTES))

    def end(self) -> None:
        """End the server after the running test."""
        self._connection.close()
        try:
            self._process.wait(TIMEOUT_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._directory.cleanup()


def _problem_of(status: int) -> str | None:
    return None if status in TEST_RAN else f"exit status {status} of the test's process"


def _leftover_problem(platform: str) -> str | None:
    if not IS_MANYCORE:
        return None
    try:
        wait_until(lambda: not leftovers(platform), f"{platform} leaves nothing in /dev/shm")
    except AssertionError as error:
        return f"{error}: {leftovers(platform)}"
    return None


def _to_report(config: pytest.Config, data: dict[str, Any]) -> pytest.TestReport:
    report = config.hook.pytest_report_from_serializable(config=config, data=data)
    assert isinstance(report, pytest.TestReport)
    if report.skipped and isinstance(report.longrepr, list):
        report.longrepr = tuple(report.longrepr)  # JSON turned tuples into lists
    return report


def _failure(item: pytest.Item, problem: str) -> pytest.TestReport:
    return pytest.TestReport(
        nodeid=item.nodeid,
        location=item.location,
        keywords={},
        outcome="failed",
        longrepr=problem,
        when="call",
    )
