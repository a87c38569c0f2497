# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The set-up shows its progress, and the reason for a failure."""

from __future__ import annotations

import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

PROGRESS = Path(__file__).parents[2] / "scripts/progress.py"
COMPILER = """
printf '[1/3] Building CXX object a.o\\n[2/3] Building CXX object b.o\\n'
"""
BROKEN = """
echo '[1/3] Building CXX object a.o'
echo 'FAILED: a.o'
echo 'a.cpp:7:1: error: no luck'
exit 3
"""
PIP = """
echo 'Collecting ros-rclpy==7.1.6 (from -r requirements.txt)'
echo '  Downloading ros_rclpy-7.1.6-cp311-cp311-manylinux_2_28_x86_64.whl (1.2 MB)'
echo 'Collecting numpy'
echo 'Installing collected packages: numpy, ros-rclpy'
"""


def command(directory: Path, shell: str) -> list[str | Path]:
    return [sys.executable, PROGRESS, directory / "log", "compiling", "sh", "-c", shell]


def on_terminal(directory: Path, shell: str) -> str:
    """Return the output to a terminal."""
    end, terminal = pty.openpty()
    subprocess.run(command(directory, shell), stdout=terminal, check=True, timeout=60)
    os.close(terminal)
    with open(end, "rb") as file:
        return file.read1().decode()


def test_a_terminal_shows_every_step_in_one_line(tmp_path: Path) -> None:
    *steps, end = on_terminal(tmp_path, COMPILER).split("\r\033[K")
    assert steps == ["", "compiling", "compiling: 1 of 3", "compiling: 2 of 3"]
    assert re.fullmatch(r"compiling: done in \d+ s\s+", end)


def test_packages_are_counted(tmp_path: Path) -> None:
    shown = on_terminal(tmp_path, PIP).split("\r\033[K")
    assert shown[2:6] == [
        "compiling: 1 found",
        "compiling: 1 found, downloading ros_rclpy (1.2 MB)",
        "compiling: 2 found",
        "compiling: unpacking 2",
    ]


def test_a_file_gets_few_lines_and_the_log_all(tmp_path: Path) -> None:
    result = subprocess.run(command(tmp_path, COMPILER), capture_output=True, text=True)
    assert re.fullmatch(r"compiling\ncompiling: done in \d+ s\n", result.stdout)
    assert "Building CXX object b.o" in (tmp_path / "log").read_text()


def test_a_failure_shows_the_compilers_output(tmp_path: Path) -> None:
    result = subprocess.run(command(tmp_path, BROKEN), capture_output=True, text=True)
    assert result.returncode == 3
    assert "compiling: failed in " in result.stdout
    assert result.stderr.splitlines() == [
        "FAILED: a.o",
        "a.cpp:7:1: error: no luck",
        f"Full output: {tmp_path}/log",
    ]
