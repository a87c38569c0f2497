# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Warnings and errors of the newest ROS 2 log files; other lines may quote messages."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

_FILES = 3
_LINES = 20
_READ_BYTES = 1 << 16
_SEVERE = re.compile(r"\[(WARN|ERROR|FATAL)\]")


def recent_lines() -> list[dict[str, Any]] | str:
    """Return the last warnings and errors of the newest files."""
    directory = log_directory()
    files = sorted(directory.glob("*.log"), key=lambda file: file.stat().st_mtime)[-_FILES:]
    if not files:
        return f"no log files in {directory}"
    return [{"file": file.name, "lines": _severe(file)} for file in reversed(files)]


def log_directory() -> Path:
    """Return the directory that rcl logs to."""
    if named := os.environ.get("ROS_LOG_DIR"):
        return Path(named).expanduser()
    return Path(os.environ.get("ROS_HOME") or "~/.ros").expanduser() / "log"


def _severe(file: Path) -> list[str]:
    with file.open("rb") as opened:
        opened.seek(max(0, file.stat().st_size - _READ_BYTES))
        lines = opened.read().decode(errors="replace").splitlines()
    return [line for line in lines if _SEVERE.search(line)][-_LINES:]
