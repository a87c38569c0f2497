# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Resource limits of a process, and kernel settings that matter to transports."""

from __future__ import annotations

import resource
from pathlib import Path

_LIMITS = ("NOFILE", "MEMLOCK", "RTPRIO", "NICE", "NPROC", "STACK", "CORE", "AS")
_SETTINGS = (
    *("net.core.rmem_default", "net.core.rmem_max", "net.core.wmem_default", "net.core.wmem_max"),
    *("net.ipv4.ipfrag_high_thresh", "fs.pipe-max-size", "fs.pipe-user-pages-soft"),
    *("kernel.pid_max", "kernel.sched_rt_runtime_us", "kernel.sched_autogroup_enabled"),
    *("vm.overcommit_memory", "vm.max_map_count"),
)


def limits() -> dict[str, dict[str, int | str]]:
    """Return the soft and hard limits of this process."""
    return {
        f"RLIMIT_{name}": {"soft": _shown(soft), "hard": _shown(hard)}
        for name in _LIMITS
        for soft, hard in [resource.getrlimit(getattr(resource, f"RLIMIT_{name}"))]
    }


def kernel_settings() -> dict[str, str]:
    """Return kernel settings under their sysctl names."""
    return {name: _setting(name) for name in _SETTINGS}


def _shown(limit: int) -> int | str:
    return "unlimited" if limit == resource.RLIM_INFINITY else limit


def _setting(name: str) -> str:
    try:
        return Path("/proc/sys", *name.split(".")).read_text().strip()
    except OSError as error:
        return f"not readable: {error.strerror}"
