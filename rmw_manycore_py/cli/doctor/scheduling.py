# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Doctor checks: isolated CPUs, and permission for real-time priorities."""

from __future__ import annotations

from pathlib import Path

from rmw_manycore_py.cli.doctor.finding import Finding, Verdict
from rmw_manycore_py.platform.topology import isolated_cpus
from rmw_manycore_py.process.scheduling import MAX_PRIORITY, Scheduling, real_time_limit, refusal

_RUNTIME = Path("/proc/sys/kernel/sched_rt_runtime_us")


def check_isolation(system: Path = Path("/sys/devices/system/cpu")) -> Finding:
    """Report the isolated CPUs; only nodes with a `host_cpu` run on them."""
    try:
        listed = (system / "isolated").read_text().strip()
    except OSError:
        listed = ""
    if not listed:
        return Finding("isolated CPUs", Verdict.OK, "none")
    usable = isolated_cpus(system)
    named = ", ".join(map(str, usable)) or "none of them"
    found = f"{listed}; nodes may name {named} as host_cpu"
    advice = "" if usable else "they are outside the cpuset of this process"
    return Finding("isolated CPUs", Verdict.OK, found, advice)


def check_real_time() -> Finding:
    """Report which priorities the key `scheduling` of a mapfile may use."""
    subject = "real-time scheduling"
    highest = Scheduling("fifo", MAX_PRIORITY)
    reason = refusal(highest)
    if reason is None:
        return Finding(subject, Verdict.OK, f"fifo and rr up to {MAX_PRIORITY}{_throttled()}")
    limit = real_time_limit()
    if limit > 0 and refusal(Scheduling("fifo", limit)) is None:
        return Finding(subject, Verdict.OK, f"fifo and rr up to {limit}{_throttled()}")
    advice = f"only for nodes with fifo or rr as scheduling: {reason}"
    return Finding(subject, Verdict.OK, "not allowed", advice)


def _throttled() -> str:
    try:
        runtime_us = int(_RUNTIME.read_text())
    except (OSError, ValueError):
        return ""
    if runtime_us < 0:
        return "; not throttled: a node that never blocks starves its CPU"
    return ""
