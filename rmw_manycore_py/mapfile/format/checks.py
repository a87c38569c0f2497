# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Checks beyond types: placement, ways to start, referenced files."""

from __future__ import annotations

import os
from collections.abc import Iterator

from rmw_manycore_py.errors import Problem
from rmw_manycore_py.mapfile.format.document import KeyPath
from rmw_manycore_py.mapfile.format.mapfile import Mapfile
from rmw_manycore_py.mapfile.format.model import NodeSection
from rmw_manycore_py.platform.topology import Core
from rmw_manycore_py.ros.names import expand, full_node_name, resolve_topic

# Set from the placement; overriding them would move a node elsewhere.
NODE_VARIABLES = ("MANYCORE_PLATFORM", "MANYCORE_CLUSTER", "MANYCORE_CORE")
PLACE_VARIABLES = ("MANYCORE_DIRECTORY", *NODE_VARIABLES)
WAYS_TO_START = ("module", "script", "executable", "command")


def check_placement(mapfile: Mapfile) -> Iterator[Problem]:
    """Yield nodes outside a cluster, on reserved cores, or sharing a core."""
    taken: dict[Core, str] = {}
    for name, node in mapfile.sections.nodes.items():
        problem = _misplaced(mapfile, name, node)
        if problem:
            yield problem
        elif node.core is not None:
            core = Core(node.cluster, node.core)
            if core in taken and not mapfile.sections.allow_shared_cores:
                expected = "a core of its own (allow_shared_cores: true lifts this)"
                found = f"{core}, where '{taken[core]}' runs"
                yield mapfile.document.problem(("nodes", name, "core"), expected, found)
            taken.setdefault(core, name)


def _misplaced(mapfile: Mapfile, name: str, node: NodeSection) -> Problem | None:
    topology = mapfile.topology
    problem = mapfile.document.problem
    cluster = topology.cluster(node.cluster)
    if cluster is None:
        expected = f"1 to {len(topology.clusters)}, the clusters of '{topology.profile}'"
        return problem(("nodes", name, "cluster"), expected, str(node.cluster))
    if node.core is None:
        return None
    if node.core >= cluster.cores:
        expected = f"0 to {cluster.cores - 1}, the cores of cluster {cluster.id}"
        return problem(("nodes", name, "core"), expected, str(node.core))
    if node.core in cluster.reserved and not mapfile.sections.allow_reserved_cores:
        expected = (
            f"a core that is free, {cluster.free[0]} to {cluster.free[-1]} "
            "(allow_reserved_cores: true lifts this)"
        )
        return problem(("nodes", name, "core"), expected, f"the reserved core {node.core}")
    return None


def check_hosts(mapfile: Mapfile) -> Iterator[Problem]:
    """Yield clusters that no host has or that two have, and topics that two hosts bridge."""
    sections, problem = mapfile.sections, mapfile.document.problem
    if not sections.hosts:
        return
    owners: dict[int, str] = {}
    for host, section in sections.hosts.items():
        path = ("hosts", host, "clusters")
        for number in section.clusters:
            if mapfile.topology.cluster(number) is None:
                expected = f"1 to {len(mapfile.topology.clusters)}, the clusters of the platform"
                yield problem(path, expected, str(number))
            elif owners.setdefault(number, host) != host:
                yield problem(
                    path, "each cluster on one host", f"{number}, which is on {owners[number]}"
                )
    crossing: dict[str, str] = {}
    for name, node in sections.nodes.items():
        owner = owners.get(node.cluster)
        if owner is None:
            path = ("nodes", name, "cluster")
            yield problem(path, "the cluster of a host", f"{node.cluster}, which no host has")
            continue
        for key in ("topic_in", "topic_to"):
            for topic in getattr(node, key):
                full = _full_topic_name(topic, name, node)
                if (other := crossing.setdefault(f"{key} {full}", owner)) != owner:
                    expected = f"{topic} bridged by one host: it would come twice"
                    yield problem(("nodes", name, key, topic), expected, f"it on {other}, too")


def _full_topic_name(topic: str, name: str, node: NodeSection) -> str:
    """Return a topic's full name, as far as the mapfile alone has it."""
    own, _, last = name.rpartition("/")
    full_name = full_node_name(node.namespace or own, last)
    return resolve_topic(topic, full_name, tuple(node.remappings.items()))


def check_topic_names(mapfile: Mapfile) -> Iterator[Problem]:
    """Yield topics that a section has twice, and names of a node where there is none."""
    sections, problem = mapfile.sections, mapfile.document.problem
    for keys, named in (
        (("topics",), sections.topics),
        (("bridge", "routes"), sections.bridge.routes),
    ):
        seen: dict[str, str] = {}
        for name in named:
            if name.startswith("~"):
                expected = "a full name: here is no node whose name '~' stands for"
                yield problem((*keys, name), expected, f"'{name}'")
            elif (other := seen.setdefault(expand(name, "/"), name)) != name:
                yield problem((*keys, name), "each topic once", f"'{name}', also as '{other}'")


def check_starts(mapfile: Mapfile) -> Iterator[Problem]:
    """Yield nodes with no way to start, or with several."""
    for name, node in mapfile.sections.nodes.items():
        ways = [way for way in WAYS_TO_START if getattr(node, way) is not None]
        path = ("nodes", name)
        if len(ways) > 1:
            expected = f"only one of {', '.join(WAYS_TO_START)}"
            yield mapfile.document.problem((*path, ways[1]), expected, " and ".join(ways))
        elif not ways and mapfile.sections.launch_path is None:
            expected = f"one of {', '.join(WAYS_TO_START)}, or a launch_path that has the node"
            yield mapfile.document.problem(path, expected, "no way to start the node")
        if (node.package is None) != (node.executable is None):
            one, other = "package", "executable"
            if node.package is None:
                one, other = other, one
            yield mapfile.document.problem((*path, one), f"'{other}' beside '{one}'", "it alone")
        if not node.ros_arguments and node.command is None:
            expected = "true, except beside 'command'"
            yield mapfile.document.problem((*path, "ros_arguments"), expected, "false")


def check_environment(mapfile: Mapfile) -> Iterator[Problem]:
    """Yield environment variables that would override a node's placement."""
    for name, node in mapfile.sections.nodes.items():
        for variable in PLACE_VARIABLES:
            if variable in node.env:
                expected = "no variable that says where the platform or the node is"
                path = ("nodes", name, "env", variable)
                yield mapfile.document.problem(path, expected, f"'{variable}'")


def check_files(mapfile: Mapfile) -> Iterator[Problem]:
    """Yield files named in the mapfile that do not exist."""
    named: list[tuple[KeyPath, str | None]] = [(("launch_path",), mapfile.sections.launch_path)]
    for name, node in mapfile.sections.nodes.items():
        named.append((("nodes", name, "script"), node.script))
        named += [(("nodes", name, "param_file"), file) for file in node.param_file]
    for path, file in named:
        if file is not None and not os.path.isfile(mapfile.file(file)):
            yield mapfile.document.problem(path, "an existing file", str(mapfile.file(file)))
