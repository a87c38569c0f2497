# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The commands of peers, examples and the command line tool."""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from support.peers.client import PEER


def peer_command(function: Callable[..., None], *arguments: Any) -> list[str]:
    """Return the command that calls a function of a test file in a new process."""
    source = function.__code__.co_filename
    return [sys.executable, str(PEER), source, function.__name__, json.dumps(arguments)]


def example_command(name: str, *arguments: str) -> list[str]:
    """Return the command that runs one of the example nodes."""
    return [sys.executable, "-m", f"rmw_manycore_py.examples.{name}", *arguments]


def manycore_command(*arguments: str | Path) -> list[str | Path]:
    """Return the command of the `manycore` installed beside this Python."""
    beside = Path(sys.executable).with_name("manycore")
    return [beside if beside.exists() else shutil.which("manycore") or "manycore", *arguments]
