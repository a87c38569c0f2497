# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The platforms of tests: their names, the environment of their nodes, and what they leave."""

from __future__ import annotations

import itertools
import os
from contextlib import suppress
from pathlib import Path

from support import RMW
from support.processes.domains import domain_of

PLATFORMS = Path(f"/dev/shm/manycore-{os.getuid()}")

_numbers = itertools.count()


def unique_platform() -> str:
    """Return a platform name that no other test uses."""
    return f"test-{os.getpid()}-{next(_numbers)}"


def environment(platform: str, cluster: int = 1, **more: str) -> dict[str, str]:
    """Return the environment of a node in a cluster of a platform.

    Other middlewares have no platforms: there each platform is a separate ROS domain.
    """
    return {
        **os.environ,
        "RMW_IMPLEMENTATION": RMW,
        "MANYCORE_PLATFORM": platform,
        "MANYCORE_CLUSTER": str(cluster),
        "ROS_DOMAIN_ID": str(domain_of(platform)),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "PYTHONUNBUFFERED": "1",
        **more,
    }


def leftovers(platform: str) -> list[Path]:
    """Return the files that a platform has left in shared memory."""
    directory = PLATFORMS / platform
    with suppress(FileNotFoundError):  # the last process may remove it concurrently
        return [directory, *directory.rglob("*")] if directory.exists() else []
    return []


def entries(directory: Path, pattern: str) -> list[Path]:
    """Return the matching files of a directory that the last process may remove concurrently."""
    with suppress(FileNotFoundError):
        return list(directory.glob(pattern))
    return []
