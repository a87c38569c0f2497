# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A node on its core: command line, environment, topics, rules."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from rmw_manycore_py.mapfile.format.checks import PLACE_VARIABLES
from rmw_manycore_py.mapfile.format.mapfile import Mapfile
from rmw_manycore_py.mapfile.format.model import NodeSection
from rmw_manycore_py.mapfile.placing.placement import LaunchRules, PlacedNode
from rmw_manycore_py.mapfile.placing.prefix import placed_again
from rmw_manycore_py.mapfile.placing.start import NodeStart, ros_arguments
from rmw_manycore_py.platform.topology import WORKER_CPUS, Core
from rmw_manycore_py.process.scheduling import Scheduling
from rmw_manycore_py.ros.ament import canonical_type
from rmw_manycore_py.ros.domain import is_elsewhere

# Larger than any message, so that glibc keeps freed memory instead of faulting it in again.
_MALLOC_THRESHOLD = str(1 << 30)


def place(
    mapfile: Mapfile,
    name: str,
    start: NodeStart,
    core: Core,
    workers: tuple[Core, ...],
    host_cpus: Mapping[Core, int],
    launched: LaunchRules,
) -> PlacedNode:
    """Return a node on its core; `launched` are the launch file's rules."""
    node = mapfile.sections.nodes[name]
    scheduling = _scheduling(node)
    host_cpu = host_cpus[core]
    publish, subscribe = _topics_of(node, start)
    placed_workers = tuple((worker, host_cpus[worker]) for worker in workers)
    worker_cpus = ",".join(str(cpu) for _, cpu in placed_workers)
    worker_environment = {WORKER_CPUS: worker_cpus} if workers else {}
    return PlacedNode(
        name=name,
        full_name=start.full_name,
        cluster=core.cluster,
        core=core.core,
        host_cpu=host_cpu,
        env={**_environment(mapfile, node, core, start), **worker_environment},
        cwd=_directory(mapfile, start),
        program=() if start.missing else _program(start, host_cpu, scheduling),
        missing="; ".join(f"expected {one.expected}, found {one.found}" for one in start.missing),
        ros_arguments=ros_arguments(start),
        parameters=start.parameters,
        parameter_sources=start.parameter_sources,
        publish=publish,
        subscribe=subscribe,
        workers=placed_workers,
        rules=_rules(node, launched),
        terminal=node.terminal,
        scheduling=scheduling,
        depths=_depths(start),
        has_unknown_topics=_has_unknown_topics(node, start),
    )


def _program(start: NodeStart, host_cpu: int, scheduling: Scheduling | None) -> tuple[str, ...]:
    """Return the command line without ROS arguments; its prefix does not undo the placement."""
    prefix = start.program.prefix
    again = placed_again(prefix, host_cpu, scheduling)
    return (*prefix, *again, *start.program.argv, *start.arguments)


def _scheduling(node: NodeSection) -> Scheduling | None:
    section = node.scheduling
    return Scheduling(section.policy, section.priority or 0) if section else None


def _rules(node: NodeSection, launched: LaunchRules) -> LaunchRules:
    """Return the launch file's rules, overridden by the mapfile's."""
    launched = replace(launched, ends_run=launched.ends_run or node.ends_run)
    if node.respawn is None:
        return launched
    retries = node.respawn.max_retries
    return replace(
        launched,
        respawn_delay_s=node.respawn.delay,
        max_respawns=-1 if retries is None else retries,
    )


def _directory(mapfile: Mapfile, start: NodeStart) -> Path:
    return (mapfile.path.parent / (start.directory or "")).resolve()


def _environment(
    mapfile: Mapfile, node: NodeSection, core: Core, start: NodeStart
) -> dict[str, str]:
    place = {
        "MANYCORE_PLATFORM": mapfile.platform_name,
        "MANYCORE_CLUSTER": str(core.cluster),
        "MANYCORE_CORE": str(core.core),
    }
    env = {
        "RMW_IMPLEMENTATION": "rmw_manycore",
        "MANYCORE_WAIT": node.wait or "block",
        "PYTHONUNBUFFERED": "1",
    }
    if design := node.receive:
        env["MANYCORE_RECEIVE"] = design
    if mapfile.sections.allow_shared_cores:
        env["MANYCORE_SHARED_CORE"] = "1"
    if mapfile.sections.malloc_tuning:
        env["MALLOC_TRIM_THRESHOLD_"] = env["MALLOC_MMAP_THRESHOLD_"] = _MALLOC_THRESHOLD
    # A launch file may set all variables except those of the placement.
    asked = {name: value for name, value in start.env.items() if name not in PLACE_VARIABLES}
    if is_elsewhere(asked):  # empty: the environment of `manycore run` may set them
        place = dict.fromkeys(place, "")
    return {**env, **asked, **place}


def _topics_of(node: NodeSection, start: NodeStart) -> tuple[dict[str, str], dict[str, str]]:
    """Return published and subscribed topics, from the mapfile and the source."""
    result = []
    for key in ("publish", "subscribe"):
        written = {**getattr(start.shown, key, {}), **getattr(node, key)}
        result.append(
            {start.topic(topic): canonical_type(type_name) for topic, type_name in written.items()}
        )
    return result[0], result[1]


def _depths(start: NodeStart) -> dict[tuple[str, str], int]:
    shown = start.shown.depths if start.shown else {}
    return {(key, start.topic(topic)): depth for (key, topic), depth in shown.items()}


def _has_unknown_topics(node: NodeSection, start: NodeStart) -> bool:
    is_clear = start.shown is not None and not start.shown.unclear
    return not is_clear and not node.publish and not node.subscribe
