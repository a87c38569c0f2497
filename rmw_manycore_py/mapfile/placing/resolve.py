# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""From a mapfile to a placement: resolves programs, cores, host CPUs and topics."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import Path

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.format.checks import PLACE_VARIABLES
from rmw_manycore_py.mapfile.format.mapfile import Mapfile
from rmw_manycore_py.mapfile.format.model import NodeSection
from rmw_manycore_py.mapfile.launch_file import LaunchedNode, LaunchFile, read_launch_file
from rmw_manycore_py.mapfile.placing.cores import assign_cores, assign_cpus
from rmw_manycore_py.mapfile.placing.crossings import bridge_placement
from rmw_manycore_py.mapfile.placing.foreign import foreign_starts
from rmw_manycore_py.mapfile.placing.imports import check_imports, notices_of_imports
from rmw_manycore_py.mapfile.placing.launched import launch_rules
from rmw_manycore_py.mapfile.placing.notices import (
    elsewhere,
    overruled_prefixes,
    refused_scheduling,
    unpublished,
)
from rmw_manycore_py.mapfile.placing.placement import (
    LaunchRules,
    PlacedNode,
    Placement,
)
from rmw_manycore_py.mapfile.placing.prefix import placed_again
from rmw_manycore_py.mapfile.placing.sessions import check_sessions
from rmw_manycore_py.mapfile.placing.start import NodeStart, node_start, ros_arguments
from rmw_manycore_py.mapfile.placing.topics import (
    check_crossing_types,
    check_memory,
    check_types,
    memory_of_clusters,
    topic_table,
)
from rmw_manycore_py.mapfile.placing.workers import worker_cores
from rmw_manycore_py.mapfile.programs.source import SourceNode, scan
from rmw_manycore_py.platform.topology import (
    WORKER_CPUS,
    Core,
    usable_cpus,
)
from rmw_manycore_py.process.scheduling import Scheduling
from rmw_manycore_py.ros.ament import canonical_type
from rmw_manycore_py.ros.domain import default_platform, is_elsewhere
from rmw_manycore_py.ros.names import full_node_name, resolve_topic

# Larger than any message, so that glibc keeps freed memory instead of faulting it in again.
_MALLOC_THRESHOLD = str(1 << 30)


def resolve(
    mapfile: Mapfile, occupied: Collection[Core] = (), *, to_start: bool = True
) -> Placement:
    """Resolve everything a mapfile refers to.

    :param occupied: cores used by nodes of other runs on the platform.
    :param to_start: false to look only: then nodes of a plan need not be installed.
    :raises MapfileError: for everything that does not exist.
    """
    launch = read_launch(mapfile)
    is_plan = mapfile.sections.plan and not to_start
    return _placement(mapfile, node_starts(mapfile, launch, is_plan=is_plan), launch, occupied)


def resolve_places(mapfile: Mapfile) -> Placement:
    """Resolve the placement of a mapfile whose nodes are started by `ros2 launch`.

    The command lines of the placed nodes are empty.

    :raises MapfileError: for invalid placements.
    """
    return _placement(mapfile, foreign_starts(mapfile), None, ())


def _placement(
    mapfile: Mapfile,
    starts: dict[str, NodeStart],
    launch: LaunchFile | None,
    occupied: Collection[Core],
) -> Placement:
    cores = assign_cores(mapfile, occupied)
    workers = worker_cores(mapfile, {*cores.values(), *occupied})
    of_workers = [core for one in workers.values() for core in one]
    bridge = bridge_placement(mapfile, starts, {*cores.values(), *of_workers, *occupied})
    cpus = usable_cpus()
    host_cpus = assign_cpus(mapfile, [*cores.values(), *of_workers], bridge, cpus)
    launched = {name: start.launched for name, start in starts.items()}
    nodes = tuple(
        replace(
            _place(mapfile, name, start, cores[name], workers[name], host_cpus),
            rules=_rules(mapfile.sections.nodes[name], launch_rules(name, launched)[0]),
        )
        for name, start in starts.items()
    )
    of_imports = notices_of_imports(starts)
    of_rules = [text for name in starts for text in launch_rules(name, launched)[1]]
    topics = topic_table(mapfile, nodes)
    memory = memory_of_clusters(mapfile, topics)
    problems = [
        *check_types(mapfile, topics),
        *check_crossing_types(mapfile, starts, topics),
        *check_imports(mapfile, starts),
        *check_memory(mapfile, memory),
        *check_sessions(mapfile, topics),
    ]
    if problems:
        raise MapfileError(*problems)
    return Placement(
        name=platform_name(mapfile),
        topology=mapfile.topology,
        nodes=nodes,
        topics=topics,
        memory=memory,
        host_cpus=host_cpus,
        bridge=bridge,
        notices=(
            *mapfile.notices,
            *_notices(mapfile, launch, host_cpus, cpus),
            *(*of_rules, *of_imports),
            *unpublished(mapfile, starts, nodes),
            *refused_scheduling(nodes),
            *overruled_prefixes(starts, nodes),
            *elsewhere(platform_name(mapfile), nodes),
        ),
    )


def platform_name(mapfile: Mapfile) -> str:
    """Return the platform's name; default: the platform of nodes started by hand."""
    return mapfile.sections.platform.name or default_platform()


def read_launch(mapfile: Mapfile) -> LaunchFile | None:
    """Read the launch file of a mapfile, if it has one."""
    sections = mapfile.sections
    if sections.launch_path is None:
        return None
    launch = read_launch_file(mapfile.file(sections.launch_path), sections.launch_arguments)
    known = ", ".join(sorted(launch.arguments)) or "it has none"
    problems = [
        mapfile.document.problem(
            ("launch_arguments", name), f"an argument of the launch file ({known})", f"'{name}'"
        )
        for name in sections.launch_arguments
        if name not in launch.arguments
    ]
    if problems:
        raise MapfileError(*problems)
    return launch


def node_starts(
    mapfile: Mapfile, launch: LaunchFile | None, *, is_plan: bool = False
) -> dict[str, NodeStart]:
    """Return how each node is started; raise MapfileError for what does not exist.

    :param is_plan: whether programs may be missing.
    """
    starts: dict[str, NodeStart] = {}
    owners: dict[str, str] = {}
    problems: list[Problem] = []
    for name in mapfile.sections.nodes:
        try:
            start = node_start(mapfile, name, launch)
        except MapfileError as error:
            problems += error.problems
            continue
        if not is_plan:
            problems += start.missing
        starts[name] = start
        if start.full_name in owners and not _has_number(start):
            found = f"{start.full_name}, the name of '{owners[start.full_name]}'"
            problems.append(mapfile.document.problem(("nodes", name), "a name of its own", found))
        owners.setdefault(start.full_name, name)
    if problems:
        raise MapfileError(*problems)
    return starts


def _has_number(start: NodeStart) -> bool:
    """Return whether the launch file starts several nodes of one name."""
    return isinstance(start.launched, LaunchedNode) and start.launched.number > 1


def _place(
    mapfile: Mapfile,
    name: str,
    start: NodeStart,
    core: Core,
    workers: tuple[Core, ...],
    host_cpus: dict[Core, int],
) -> PlacedNode:
    publish, subscribe = _topics_of(mapfile, name, start)
    placed_workers = tuple((worker, host_cpus[worker]) for worker in workers)
    worker_cpus = ",".join(str(cpu) for _, cpu in placed_workers)
    worker_environment = {WORKER_CPUS: worker_cpus} if workers else {}
    return PlacedNode(
        name=name,
        full_name=start.full_name,
        cluster=core.cluster,
        core=core.core,
        host_cpu=host_cpus[core],
        env={**_environment(mapfile, name, core, start), **worker_environment},
        cwd=_directory(mapfile, start),
        program=() if start.missing else _program(mapfile, name, start, host_cpus[core]),
        missing="; ".join(f"expected {one.expected}, found {one.found}" for one in start.missing),
        ros_arguments=ros_arguments(start),
        parameters=start.parameters,
        parameter_sources=start.parameter_sources,
        publish=publish,
        subscribe=subscribe,
        workers=placed_workers,
        terminal=mapfile.sections.nodes[name].terminal,
        scheduling=_scheduling(mapfile.sections.nodes[name]),
    )


def _program(mapfile: Mapfile, name: str, start: NodeStart, host_cpu: int) -> tuple[str, ...]:
    """Return the command line without ROS arguments; its prefix does not undo the placement."""
    prefix = start.program.prefix
    scheduling = _scheduling(mapfile.sections.nodes[name])
    again = placed_again(prefix, host_cpu, scheduling)
    return (*prefix, *again, *start.program.argv, *start.arguments)


def _scheduling(node: NodeSection) -> Scheduling | None:
    section = node.scheduling
    return Scheduling(section.policy, section.priority or 0) if section else None


def _rules(node: NodeSection, launched: LaunchRules) -> LaunchRules:
    """Return the launch file's rules, overridden by the mapfile's."""
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


def _environment(mapfile: Mapfile, name: str, core: Core, start: NodeStart) -> dict[str, str]:
    place = {
        "MANYCORE_PLATFORM": platform_name(mapfile),
        "MANYCORE_CLUSTER": str(core.cluster),
        "MANYCORE_CORE": str(core.core),
    }
    env = {
        "RMW_IMPLEMENTATION": "rmw_manycore",
        "MANYCORE_WAIT": mapfile.sections.nodes[name].wait or "block",
        "PYTHONUNBUFFERED": "1",
    }
    if design := mapfile.sections.nodes[name].receive:
        env["MANYCORE_RECEIVE"] = design
    if mapfile.sections.malloc_tuning:
        env["MALLOC_TRIM_THRESHOLD_"] = env["MALLOC_MMAP_THRESHOLD_"] = _MALLOC_THRESHOLD
    # A launch file may set all variables except those of the placement.
    asked = {name: value for name, value in start.env.items() if name not in PLACE_VARIABLES}
    if is_elsewhere(asked):  # empty: the environment of `manycore run` may set them
        place = dict.fromkeys(place, "")
    return {**env, **asked, **place}


def _topics_of(
    mapfile: Mapfile, name: str, start: NodeStart
) -> tuple[dict[str, str], dict[str, str]]:
    """Return published and subscribed topics, from the mapfile and the source."""
    node = mapfile.sections.nodes[name]
    shown = _shown_by_source(start)
    result = []
    for key in ("publish", "subscribe"):
        written = {**getattr(shown, key, {}), **getattr(node, key)}
        result.append(
            {
                resolve_topic(topic, start.full_name, start.remappings): canonical_type(type_name)
                for topic, type_name in written.items()
            }
        )
    return result[0], result[1]


def _shown_by_source(start: NodeStart) -> SourceNode | None:
    source: Path | None = start.program.source
    if source is None:
        return None
    try:
        nodes = scan(source)
    except MapfileError:
        return None  # Python reports the error at run time.
    return nodes[0] if len(nodes) == 1 else None


def _notices(
    mapfile: Mapfile,
    launch: LaunchFile | None,
    host_cpus: dict[Core, int],
    cpus: Sequence[int],
) -> list[str]:
    notices = list(launch.notices) if launch else []
    for node in launch.nodes if launch else ():
        full = full_node_name(node.namespace, node.label)
        if not {node.label, full, full[1:]} & set(mapfile.sections.nodes):
            place = f"{node.file}:{node.line}"
            notices.append(f"{place}: '{node.label}' is not in the mapfile and does not run here")
    if len(host_cpus) > len(cpus):
        notices.append(
            f"{len(host_cpus)} cores in use on {len(cpus)} host CPUs: some share a CPU, "
            "so timing is not that of the target"
        )
    return notices
