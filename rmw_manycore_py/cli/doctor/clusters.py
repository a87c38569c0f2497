# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Doctor checks: clusters of this machine, and what would keep other programs out of them.

Nothing here is configured: each finding only reports what the kernel could add,
and what permits it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path

from rmw_manycore_py.cli.doctor.finding import Finding, Verdict, advised
from rmw_manycore_py.platform.machine.clusters import HostCluster
from rmw_manycore_py.platform.machine.memory_policy import policy_refusal
from rmw_manycore_py.platform.machine.sysfs import list_of_cpus
from rmw_manycore_py.platform.texts import counted
from rmw_manycore_py.platform.topology import machine_clusters

_CGROUPS = Path("/sys/fs/cgroup")
_RESCTRL = Path("/sys/fs/resctrl")
# Allocation of L3 or of memory bandwidth: Intel RDT and AMD QoS; MPAM of Arm has no flag there.
_RESCTRL_FLAGS = frozenset({"cat_l3", "cdp_l3", "cat_l2", "mba"})
_MAX_SHOWN = 8


def check_clusters() -> Iterator[Finding]:
    """Yield findings about clusters, memory policies, cpusets and resctrl."""
    clusters = machine_clusters()
    yield _clusters(clusters)
    yield memory_policy({one.node for one in clusters}, policy_refusal())
    yield check_cpuset(Path("/proc/self/cgroup"), _CGROUPS)
    yield check_resctrl(Path("/proc/cpuinfo"), Path("/proc/filesystems"), _RESCTRL)


def _clusters(clusters: Sequence[HostCluster]) -> Finding:
    subject = "clusters of the machine"
    if not clusters:
        return Finding(subject, Verdict.OK, "none with two usable CPUs: only emulated ones")
    shown = [f"{list_of_cpus(one.cpus)} ({one.text})" for one in clusters[:_MAX_SHOWN]]
    more = [f"{len(clusters) - _MAX_SHOWN} more"] if len(clusters) > _MAX_SHOWN else []
    found = f"{counted(len(clusters), 'cluster')}: CPUs {'; '.join([*shown, *more])}"
    return Finding(subject, Verdict.OK, found)


def memory_policy(nodes: set[int | None], refusal: str) -> Finding:
    """Report whether the memory of clusters can be in their NUMA nodes."""
    known = nodes - {None}
    if len(known) < 2:
        return Finding("NUMA memory", Verdict.OK, "one node: nothing to choose")
    found = f"{len(known)} nodes; mbind: {refusal or 'allowed'}"
    advice = "start the container with --cap-add SYS_NICE; else memory is where it is first used"
    return advised("NUMA memory", not refusal, found, advice)


def check_cpuset(own: Path, mount: Path) -> Finding:
    """Report whether this session may partition CPUs with cgroup v2."""
    subject = "cpusets (cgroup v2)"
    adds = "a partition of cpusets would keep other programs off the CPUs of clusters"
    if not (mount / "cgroup.controllers").is_file():
        return Finding(subject, Verdict.OK, "cgroup v2 is not mounted", adds)
    group = mount / _group(own).lstrip("/")
    controllers = _words(group / "cgroup.controllers")
    if "cpuset" not in controllers:
        allow = "`systemctl edit user@.service` with Delegate=cpuset under [Service] allows it"
        return Finding(subject, Verdict.OK, "not delegated to this session", f"{adds}; {allow}")
    if not os.access(group / "cgroup.subtree_control", os.W_OK):
        allow = "`systemd-run --user --scope -p Delegate=cpuset` before a command, or root, may"
        return Finding(subject, Verdict.OK, "present, not writable", f"{adds}; {allow}")
    allow = "write `root` or `isolated` to cpuset.cpus.partition of a group with those CPUs"
    return Finding(subject, Verdict.OK, "delegated to this session", f"{adds}: {allow}")


def check_resctrl(cpuinfo: Path, filesystems: Path, mount: Path) -> Finding:
    """Report whether clusters could have shares of cache and memory bandwidth."""
    subject = "cache and bandwidth (resctrl)"
    adds = "it would give each cluster its ways of L3 and its memory bandwidth"
    if (mount / "schemata").is_file():
        return Finding(subject, Verdict.OK, f"mounted at {mount}", f"{adds}: root writes schemata")
    flags = next((set(line.split()) for line in _lines(cpuinfo) if line.startswith("flags")), set())
    features = sorted(flags & _RESCTRL_FLAGS)
    if "resctrl" not in _words(filesystems):
        found = f"CPU has {', '.join(features)}, the kernel lacks resctrl" if features else "none"
        return Finding(subject, Verdict.OK, found)
    found = f"available ({', '.join(features) or 'monitoring or MPAM'}), not mounted"
    allow = f"`mount -t resctrl resctrl {mount}` as root"
    return Finding(subject, Verdict.OK, found, f"{adds}: {allow}")


def _group(own: Path) -> str:
    """Return the path of this process's group in cgroup v2."""
    lines = (line.partition("0::") for line in _lines(own))
    return next((path for before, zero, path in lines if zero and not before), "/")


def _words(file: Path) -> set[str]:
    return {word for line in _lines(file) for word in line.split()}


def _lines(file: Path) -> list[str]:
    try:
        return file.read_text().splitlines()
    except OSError:
        return []
