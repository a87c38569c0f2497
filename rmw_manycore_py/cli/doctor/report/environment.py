# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Environment variables that select what is loaded; no others are reported."""

from __future__ import annotations

import os
from pathlib import Path

_PREFIXES = ("ROS_", "RMW_", "MANYCORE_")
_PATHS = ("LD_LIBRARY_PATH", "LD_PRELOAD")
_KEPT_PARTS = 3


def is_shown(name: str) -> bool:
    """Return whether the value of a variable may appear in a report."""
    return name.startswith(_PREFIXES)


def environment() -> dict[str, str]:
    """Return the variables of ROS 2, rmw_manycore and the dynamic loader."""
    variables = {name: os.environ[name] for name in sorted(os.environ) if is_shown(name)}
    loaders = {name: _shortened(os.environ[name]) for name in _PATHS if name in os.environ}
    return {**variables, **loaders}


def _shortened(paths: str) -> str:
    return os.pathsep.join(short_path(path) for path in paths.split(os.pathsep))


def short_path(path: str) -> str:
    """Return the last components of a path."""
    parts = Path(path).parts
    return path if len(parts) <= _KEPT_PARTS else str(Path("...", *parts[-_KEPT_PARTS:]))
