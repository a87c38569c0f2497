# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""launch, launch_ros and ros2cli, which PyPI lacks: installed, or from checkouts."""

from __future__ import annotations

import importlib.util
import os
import sys
from pathlib import Path

from support.installs.installing import run

# Environment variable: a directory with checkouts of launch, launch_ros and ros2cli.
CHECKOUTS_VARIABLE = "MANYCORE_ROS2_CHECKOUTS"
PACKAGES = (
    *("launch/launch", "launch/launch_xml", "launch/launch_yaml"),
    *("launch_ros/launch_ros", "launch_ros/ros2launch", "ros2cli/ros2cli", "ros2cli/ros2pkg"),
)
# From PyPI; they need no more exact versions than these.
REQUIREMENTS = ("osrf_pycommon", "lark", "importlib_metadata", "zipp", "packaging")
REASON = (
    "needs launch, launch_ros and ros2cli, which PyPI does not have: install them, or name a "
    f"directory with their checkouts in {CHECKOUTS_VARIABLE}"
)


def are_installed() -> bool:
    """Return whether this Python imports them."""
    return all(importlib.util.find_spec(name) for name in ("launch_ros", "ros2launch", "ros2cli"))


def are_available() -> bool:
    """Return whether they are installed, or can be from checkouts."""
    return are_installed() or bool(os.environ.get(CHECKOUTS_VARIABLE))


def environment(directory: Path) -> dict[str, str]:
    """Return the environment that finds them, installed into `directory` where necessary."""
    return {} if are_installed() else install(directory)


def install(directory: Path) -> dict[str, str]:
    """Install the checkouts into a directory; return the environment that finds them."""
    checkouts = Path(os.environ[CHECKOUTS_VARIABLE])
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", directory]
    run(*pip, *REQUIREMENTS, *(checkouts / name for name in PACKAGES))
    return {
        "PYTHONPATH": _before(os.environ.get("PYTHONPATH"), directory),
        "AMENT_PREFIX_PATH": _before(sys.prefix, directory),
        "PATH": _before(search_path(), directory / "bin"),
    }


def search_path() -> str:
    """Return a PATH with this Python first: the examples are `python3` scripts."""
    return _before(os.environ["PATH"], Path(sys.executable).parent)


def _before(path: str | None, directory: Path) -> str:
    return os.pathsep.join([str(directory), *([path] if path else [])])
