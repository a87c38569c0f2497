# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Directories of the user's sources."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

# Directories with such a file are skipped with their subdirectories: as in colcon, which marks so
# what it builds, installs and logs; and virtual environments.
_SKIPPED_BY = {"COLCON_IGNORE", "AMENT_IGNORE", "pyvenv.cfg"}
# Beside such a file, `build` has copies of the sources.
_PYTHON_PROJECT = {"setup.py", "setup.cfg", "pyproject.toml"}


def walk_sources(top: Path) -> Iterator[tuple[Path, list[str], list[str]]]:
    """Walk directories as os.walk does, without hidden ones and those that tools made."""
    for name, directories, files in os.walk(top):
        if _SKIPPED_BY.intersection(files):
            directories.clear()
            continue
        is_project = not _PYTHON_PROJECT.isdisjoint(files)
        directories[:] = sorted(one for one in directories if not _is_made(one, is_project))
        yield Path(name), directories, files


def _is_made(name: str, in_project: bool) -> bool:
    is_copy = in_project and name == "build"
    return is_copy or name.startswith(".") or name.endswith(".egg-info") or name == "__pycache__"
