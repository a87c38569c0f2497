# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A pytest that has imported and collected everything and forks a process for each test.

Importing pytest and rclpy costs about a second of CPU, a fork some milliseconds. It forks
before anything of ROS is initialised, so each child behaves like a new process.
"""

from __future__ import annotations

import json
import os
import socket
from pathlib import Path
from typing import Any

import pytest

from support import IS_MANYCORE, wait_until
from support.peers.forking import fork, preload
from support.processes.inspection import has_receive_threads

# Holds the file descriptor of the socket on which a server reads requests and answers with pids
# and exit statuses.
SOCKET_VARIABLE = "MANYCORE_TEST_SOCKET"
LARGEST_MESSAGE_BYTES = 1 << 16


def is_inside() -> bool:
    """Return whether this process is a fork server or was forked by one for a test."""
    return SOCKET_VARIABLE in os.environ


class ForkServer:
    """Run the requested tests only; a forked process is a session of one test."""

    def __init__(self, config: pytest.Config) -> None:
        self._config = config
        self._reports: Path | None = None
        # Threads of numpy would not survive the fork, so the server imports it single-threaded.
        os.environ.pop("OPENBLAS_NUM_THREADS", None)

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        tests = {item.nodeid: item for item in session.items}
        preload()
        if request := _serve(int(os.environ[SOCKET_VARIABLE])):
            self._reports = Path(request["reports"])
            os.environ.update(request["environment"])
            test = tests[request["test"]]
            test.ihook.pytest_runtest_protocol(item=test, nextitem=None)
        return True

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        assert self._reports is not None
        data = self._config.hook.pytest_report_to_serializable(config=self._config, report=report)
        with self._reports.open("a") as file:
            file.write(json.dumps(data) + "\n")

    def pytest_sessionfinish(self) -> None:
        """End a test only once receive threads run: they remove what its process leaves."""
        platform = os.environ["MANYCORE_PLATFORM"]
        if IS_MANYCORE:
            wait_until(lambda: has_receive_threads(platform), f"the receive threads of {platform}")


def _serve(fileno: int) -> dict[str, Any] | None:
    """Fork for each request; return it in the child, and None in the parent."""
    with socket.socket(fileno=fileno) as connection:
        while message := connection.recv(LARGEST_MESSAGE_BYTES):
            if (pid := fork()) == 0:
                request: dict[str, Any] = json.loads(message)
                return request
            connection.send(str(pid).encode())
            status = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
            connection.send(str(status).encode())
    return None
