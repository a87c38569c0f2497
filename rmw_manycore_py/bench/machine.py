# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Description of the machine."""

from __future__ import annotations

import os
import platform
from importlib import metadata
from pathlib import Path

from rmw_manycore_py.platform.topology import shared_memory_place

PACKAGES = ("rmw-manycore", "ros-rclpy", "ros-rmw-fastrtps-cpp", "ros-fastrtps")


def machine_header() -> dict[str, str]:
    """Return names and values for the header of a report."""
    return {
        "processor": _processor(),
        "usable CPUs": ", ".join(str(cpu) for cpu in sorted(os.sched_getaffinity(0))),
        "memory": f"{os.sysconf('SC_PAGE_SIZE') * os.sysconf('SC_PHYS_PAGES') / 2**30:.1f} GiB",
        "shared memory": f"{_shared_memory_bytes() / 2**30:.1f} GiB in {shared_memory_place()}",
        "kernel": platform.release(),
        "python": platform.python_version(),
        "load before": f"{os.getloadavg()[0]:.2f}",
        **{name: version for name in PACKAGES if (version := _version(name))},
    }


def _processor() -> str:
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def _shared_memory_bytes() -> int:
    status = os.statvfs(shared_memory_place())
    return status.f_blocks * status.f_frsize


def _version(distribution: str) -> str | None:
    try:
        return metadata.version(distribution)
    except metadata.PackageNotFoundError:
        return None
