# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The machine: kernel, CPUs, memory."""

from __future__ import annotations

import os
import platform
from pathlib import Path
from typing import Any

from rmw_manycore_py.cli.common.printing import size_text
from rmw_manycore_py.platform.topology import shared_memory_place

_CGROUP = Path("/sys/fs/cgroup")


def machine() -> dict[str, Any]:
    """Return kernel, CPU and memory facts."""
    return {
        "distribution": _value_in(Path("/etc/os-release"), "PRETTY_NAME", "="),
        "kernel": f"{platform.system()} {platform.release()} {platform.machine()}",
        "CPU model": _value_in(Path("/proc/cpuinfo"), "model name", ":"),
        "CPUs": os.cpu_count(),
        "usable CPUs": sorted(os.sched_getaffinity(0)),
        "load": [round(load, 2) for load in os.getloadavg()],
        "memory": _value_in(Path("/proc/meminfo"), "MemTotal", ":"),
        "memory available": _value_in(Path("/proc/meminfo"), "MemAvailable", ":"),
        "shared memory": _shared_memory(),
        "cgroup": {name: _text(_CGROUP / name) for name in ("cpu.max", "memory.max", "pids.max")},
    }


def _value_in(file: Path, key: str, separator: str) -> str:
    for line in _text(file).splitlines():
        name, _, value = line.partition(separator)
        if name.strip() == key:
            return value.strip().strip('"')
    return "unknown"


def _text(file: Path) -> str:
    try:
        return file.read_text().strip()
    except OSError as error:
        return f"not readable: {error.strerror}"


def _shared_memory() -> str:
    status = os.statvfs(shared_memory_place())
    size, free = (n * status.f_frsize for n in (status.f_blocks, status.f_bavail))
    return f"{size_text(free)} free of {size_text(size)}"
