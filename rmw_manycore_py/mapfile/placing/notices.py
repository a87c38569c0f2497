# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Notices about valid mapfiles that are probably not what the author meant."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from rmw_manycore_py.errors.suggestions import did_you_mean
from rmw_manycore_py.mapfile.placing.placement import PlacedNode
from rmw_manycore_py.mapfile.placing.prefix import placed_again
from rmw_manycore_py.process.scheduling import refusal
from rmw_manycore_py.ros.domain import is_elsewhere
from rmw_manycore_py.ros.names import full_node_name
from rmw_manycore_py.ros.patterns import is_pattern

if TYPE_CHECKING:
    from rmw_manycore_py.mapfile.format.mapfile import Mapfile
    from rmw_manycore_py.mapfile.launch_file import LaunchFile
    from rmw_manycore_py.mapfile.placing.start import NodeStart
    from rmw_manycore_py.platform.topology import Topology

_UNSEEN = "; name it under `publish` if the node publishes it all the same"


def of_launch(mapfile: Mapfile, launch: LaunchFile | None) -> Iterator[str]:
    """Yield notices of the launch file, and its nodes that the mapfile does not have."""
    if launch is None:
        return
    yield from launch.notices
    for node in launch.nodes:
        full = full_node_name(node.namespace, node.label)
        if not {node.label, full, full[1:]} & set(mapfile.sections.nodes):
            place = f"{node.file}:{node.line}"
            yield f"{place}: '{node.label}' is not in the mapfile and does not run here"


def shared_cpus(cores: int, cpus: int) -> Iterator[str]:
    """Yield a notice if there are fewer host CPUs than cores in use."""
    if cores > cpus:
        yield (
            f"{cores} cores in use on {cpus} host CPUs: some share a CPU, "
            "so timing is not that of the target"
        )


def unbound_memory(topology: Topology, refusal: Callable[[], str]) -> Iterator[str]:
    """Yield a notice if clusters are in several NUMA nodes and their memory cannot be."""
    nodes = {cluster.host.node for cluster in topology.clusters if cluster.host is not None}
    if len(nodes) > 1 and (reason := refusal()):
        yield (
            f"the memory of clusters is not bound to their NUMA nodes (mbind: {reason}); "
            "a container needs --cap-add SYS_NICE"
        )


def unpublished(
    mapfile: Mapfile, starts: Mapping[str, NodeStart], nodes: Sequence[PlacedNode]
) -> Iterator[str]:
    """Yield topics in `topic_to` that no source publishes, if all sources are conclusive."""
    published = {topic for node in nodes for topic in node.publish}
    for name, section in mapfile.sections.nodes.items():
        start = starts[name]
        for written, type_name in section.topic_to.items():
            if type_name is None or is_pattern(written) or "/msg/" not in type_name:
                continue
            topic = start.topic(written)
            if topic in published or start.shown is None or not start.shown.shows_publishers:
                continue
            place = f"{mapfile.path}:{mapfile.document.line(('nodes', name, 'topic_to', written))}"
            advice = did_you_mean(topic, published) or _UNSEEN
            yield f"{place}: nodes.{name}.topic_to: no source publishes {topic}{advice}"


def starting_nothing(mapfile: Mapfile, starts: Mapping[str, NodeStart]) -> Iterator[str]:
    """Yield nodes whose `module` or `script` only defines something, and ends at once."""
    for name, section in mapfile.sections.nodes.items():
        source = starts[name].source
        started = section.module or section.script
        if started and source is not None and not source.is_program:
            key = "module" if section.module else "script"
            place = f"{mapfile.path}:{mapfile.document.line(('nodes', name, key))}"
            yield (
                f"{place}: nodes.{name}.{key}: {started} starts nothing and ends at once; call "
                "main() at its end, or name `package` and `executable` of its entry point"
            )


def refused_scheduling(nodes: Sequence[PlacedNode]) -> Iterator[str]:
    """Yield nodes whose scheduling policy this user may not set; `manycore run` rejects them."""
    for node in nodes:
        if node.scheduling is not None and (reason := refusal(node.scheduling)):
            yield f"'{node.name}' cannot run here: {reason}"


def overruled_prefixes(
    starts: Mapping[str, NodeStart], nodes: Sequence[PlacedNode]
) -> Iterator[str]:
    """Yield nodes whose launch prefix contradicts the placement of the mapfile."""
    for node in nodes:
        start = starts[node.name]
        if placed_again(start.program.prefix, node.host_cpu, node.scheduling):
            launched = start.launched
            assert launched is not None
            yield (
                f"{launched.file}:{launched.line}: the mapfile overrules the prefix "
                f"'{shlex.join(start.program.prefix)}' of '{node.name}': host CPU {node.host_cpu}"
                + (f", scheduling {node.scheduling}" if node.scheduling else "")
            )


def elsewhere(platform: str, nodes: Sequence[PlacedNode]) -> Iterator[str]:
    """Yield nodes that their ROS domain keeps apart from the platform."""
    for node in nodes:
        if is_elsewhere(node.env):
            domain = node.env["ROS_DOMAIN_ID"]
            yield (
                f"'{node.name}' has ROS_DOMAIN_ID={domain}: it meets the nodes of that domain, "
                f"and none of platform '{platform}'"
            )
