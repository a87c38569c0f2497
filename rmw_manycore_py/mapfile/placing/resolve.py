# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""From a mapfile to a placement: resolves programs, cores, host CPUs and topics."""

from __future__ import annotations

from collections.abc import Collection
from itertools import chain

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.format.mapfile import Mapfile
from rmw_manycore_py.mapfile.launch_file import LaunchFile
from rmw_manycore_py.mapfile.placing.cores import (
    FRESH,
    Kept,
    assign_cores,
    assign_cpus,
    worker_cores,
)
from rmw_manycore_py.mapfile.placing.crossings import bridge_placement, links_placement
from rmw_manycore_py.mapfile.placing.foreign import foreign_starts
from rmw_manycore_py.mapfile.placing.imports import check_imports
from rmw_manycore_py.mapfile.placing.launched import launch_rules, read_launch
from rmw_manycore_py.mapfile.placing.memory import memory_of_clusters
from rmw_manycore_py.mapfile.placing.moves import Proposal, RoomError
from rmw_manycore_py.mapfile.placing.notices import (
    elsewhere,
    of_launch,
    overruled_prefixes,
    refused_scheduling,
    shared_cpus,
    starting_nothing,
    unbound_memory,
    unpublished,
)
from rmw_manycore_py.mapfile.placing.placed import place
from rmw_manycore_py.mapfile.placing.placement import Placement
from rmw_manycore_py.mapfile.placing.room import Placed, check_rings, check_room
from rmw_manycore_py.mapfile.placing.sessions import check_sessions
from rmw_manycore_py.mapfile.placing.start import NodeStart, node_starts
from rmw_manycore_py.mapfile.placing.topics import (
    check_crossing_types,
    check_types,
    topic_table,
)
from rmw_manycore_py.platform.machine.memory_policy import policy_refusal
from rmw_manycore_py.platform.topology import Core, usable_cpus


def resolve(
    mapfile: Mapfile,
    occupied: Collection[Core] = (),
    *,
    to_start: bool = True,
    kept: Kept = FRESH,
    launch: LaunchFile | None = None,
) -> Placement:
    """Resolve everything a mapfile refers to.

    :param occupied: cores used by nodes of other runs on the platform.
    :param to_start: False to inspect only: then nodes of a plan need not be installed.
    :param kept: places of the mapfile's nodes that run already.
    :param launch: its launch file as it was; by default, it is read.
    :raises MapfileError: for everything that does not exist.
    """
    launch = launch or read_launch(mapfile)
    is_plan = mapfile.sections.plan and not to_start
    starts = node_starts(mapfile, launch, is_plan=is_plan)
    return _placement(mapfile, starts, launch, occupied, kept)


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
    kept: Kept = FRESH,
) -> Placement:
    cores = assign_cores(mapfile, occupied, kept)
    workers, worker_problems = worker_cores(mapfile, {*cores.values(), *occupied})
    of_workers = [core for one in workers.values() for core in one]
    taken = {*cores.values(), *of_workers, *occupied}
    bridge = bridge_placement(mapfile, starts, taken)
    taken |= {core for lane in bridge.cores for core in lane} if bridge else set()
    links = links_placement(mapfile, taken)
    cpus = usable_cpus()
    beside = {core.cluster for one in (bridge, *links) if one for core in chain(*one.cores)}
    host_cpus = assign_cpus(mapfile, [*cores.values(), *of_workers], beside, cpus, kept)
    launched = {name: start.launched for name, start in starts.items()}
    rules = {name: launch_rules(name, launched) for name in starts}
    nodes = tuple(
        place(mapfile, name, start, cores[name], workers[name], host_cpus, rules[name][0])
        for name, start in starts.items()
    )
    import_problems, import_notices = check_imports(mapfile, starts)
    topics = topic_table(mapfile, nodes)
    memory = memory_of_clusters(mapfile.topology, nodes, topics)
    placed = Placed(mapfile, nodes, occupied)
    ring_problems = [*check_rings(mapfile)]
    room_problems = [*worker_problems, *([] if ring_problems else check_room(placed, memory))]
    problems = [*check_types(mapfile, topics), *check_crossing_types(mapfile, starts, topics)]
    problems += [*import_problems, *ring_problems, *room_problems]
    problems += check_sessions(mapfile, topics)
    if room_problems:
        raise RoomError(problems, Proposal.of(placed))
    if problems:
        raise MapfileError(*problems)
    return Placement(
        name=mapfile.platform_name,
        topology=mapfile.topology,
        nodes=nodes,
        topics=topics,
        memory=memory,
        host_cpus=host_cpus,
        launch=launch,
        bridge=bridge,
        links=links,
        notices=(
            *mapfile.notices,
            *of_launch(mapfile, launch),
            *shared_cpus(len(host_cpus), len(cpus)),
            *unbound_memory(mapfile.topology, policy_refusal),
            *(text for _, texts in rules.values() for text in texts),
            *import_notices,
            *unpublished(mapfile, starts, nodes),
            *starting_nothing(mapfile, starts),
            *refused_scheduling(nodes),
            *overruled_prefixes(starts, nodes),
            *elsewhere(mapfile.platform_name, nodes),
        ),
    )
