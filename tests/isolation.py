# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One process per test: a crash is the failure of one test, and each joins a fresh platform."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest
from processes import has_receive_threads
from support import (
    IS_MANYCORE,
    PATIENCE_S,
    TESTS,
    environment,
    leftovers,
    unique_platform,
    wait_until,
)

REPORT_VARIABLE = "MANYCORE_TEST_REPORT"


def is_inside() -> bool:
    """Tell whether this process is the one of a single test."""
    return REPORT_VARIABLE in os.environ


class ReportWriter:
    """Writes each report of the inner pytest for the outer one, a line of JSON each."""

    def __init__(self, config: pytest.Config, path: Path) -> None:
        self._config = config
        self._path = path

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        data = self._config.hook.pytest_report_to_serializable(config=self._config, report=report)
        with self._path.open("a") as file:
            file.write(json.dumps(data) + "\n")

    def pytest_sessionfinish(self) -> None:
        """Let nobody who has not left end before there is a receive thread to clear up after it."""
        platform = os.environ["MANYCORE_PLATFORM"]
        if IS_MANYCORE:
            wait_until(lambda: has_receive_threads(platform), f"the receive threads of {platform}")


def run(item: pytest.Item) -> None:
    """Run one test in a pytest of its own and pass its reports on."""
    item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    for report in _reports(item):
        item.ihook.pytest_runtest_logreport(report=report)
    item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)


def _reports(item: pytest.Item) -> list[pytest.TestReport]:
    platform = unique_platform()
    with tempfile.TemporaryDirectory() as directory:
        report_path = Path(directory) / "reports"
        problem = _run_pytest(item, platform, report_path)
        lines = report_path.read_text().splitlines() if report_path.exists() else []
    reports = [_to_report(item.config, json.loads(line)) for line in lines]
    if problem is None and not any(report.failed for report in reports):
        problem = _leftover_problem(platform)
    return reports if problem is None else [*reports, _failure(item, problem)]


def _run_pytest(item: pytest.Item, platform: str, report_path: Path) -> str | None:
    test = str(item.config.rootpath / item.nodeid)
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-m", "rmw", test]
    env = environment(platform, **{REPORT_VARIABLE: str(report_path)})
    try:
        result = subprocess.run(
            command,
            env=env,
            cwd=TESTS,
            text=True,
            errors="replace",
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=4 * PATIENCE_S,
        )
    except subprocess.TimeoutExpired as expired:
        return f"the test hangs:\n{expired.output!r}"
    if result.returncode in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED):
        return None
    return f"exit status {result.returncode} of the test's process:\n{result.stdout}"


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
        report.longrepr = tuple(report.longrepr)  # JSON has no tuples
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
