# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The variables that decide what is loaded and how; no others are shown."""

from __future__ import annotations

import os
from pathlib import Path

_PREFIXES = ("ROS_", "RMW_", "MANYCORE_")
_PATHS = ("LD_LIBRARY_PATH", "LD_PRELOAD")
_KEPT_PARTS = 3


def is_shown(name: str) -> bool:
    """Tell whether the value of a variable may be in a report."""
    return name.startswith(_PREFIXES)


def environment() -> dict[str, str]:
    """Return the variables of ROS 2 and of rmw_manycore, and the loader's."""
    variables = {name: os.environ[name] for name in sorted(os.environ) if is_shown(name)}
    loaders = {name: _shortened(os.environ[name]) for name in _PATHS if name in os.environ}
    return {**variables, **loaders}


def _shortened(paths: str) -> str:
    return os.pathsep.join(short_path(path) for path in paths.split(os.pathsep))


def short_path(path: str) -> str:
    """Return the last parts of a path."""
    parts = Path(path).parts
    return path if len(parts) <= _KEPT_PARTS else str(Path("...", *parts[-_KEPT_PARTS:]))
