# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mapfile of a running `ros2 launch`: placement of each node that is started."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from pathlib import Path

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError, MapfileError
from rmw_manycore_py.launch.bridge import bridge_programs
from rmw_manycore_py.launch.platform import configured_platform
from rmw_manycore_py.launch.processes.environment import IMPLEMENTATION, program_environment
from rmw_manycore_py.launch.processes.program import NodeProgram
from rmw_manycore_py.mapfile.format.checks import NODE_VARIABLES, PLACE_VARIABLES
from rmw_manycore_py.mapfile.format.loader import load_mapfile
from rmw_manycore_py.mapfile.installed import find_mapfile
from rmw_manycore_py.mapfile.launch_file import LaunchedNode, numbered
from rmw_manycore_py.mapfile.placing.launched import is_meant
from rmw_manycore_py.mapfile.placing.placement import PlacedNode
from rmw_manycore_py.mapfile.placing.resolve import resolve_places
from rmw_manycore_py.ros.domain import is_elsewhere
from rmw_manycore_py.ros.names import full_node_name

MAPFILE_VARIABLE = "MANYCORE_MAPFILE"


class ForeignLaunch:
    """Holds the mapfile's platform from the first node until `close`.

    Puts the platform name into `os.environ`, so that all children of this process join it.
    """

    def __init__(self, name: str) -> None:
        path = find_mapfile(name)
        if path is None:
            text = f"{MAPFILE_VARIABLE}: expected a mapfile, found '{name}', which does not exist"
            raise ManycoreError(text, EXIT_BAD_INPUT)
        if (found := os.environ.get("RMW_IMPLEMENTATION")) != IMPLEMENTATION:
            text = f"{MAPFILE_VARIABLE} is set: expected RMW_IMPLEMENTATION={IMPLEMENTATION}, found"
            raise ManycoreError(f"{text} {found or 'none'}; set it, or unset {MAPFILE_VARIABLE}")
        self._mapfile = load_mapfile(path, starts_nodes=False)
        self.placement = resolve_places(self._mapfile)
        self._holder = ExitStack()  # no reference to the platform remains after `close`
        self._holder.enter_context(configured_platform(self.placement))
        self._before = dict(os.environ)
        os.environ["MANYCORE_PLATFORM"] = self.placement.name
        self._taken: set[str] = set()
        self._started: dict[str, str] = {}

    def close(self) -> None:
        """Remove the platform, unless processes still use it."""
        self._holder.close()

    def describe(self) -> Iterator[tuple[bool, str]]:
        """Yield lines about the platform, each with whether it is a warning."""
        topology = self.placement.topology
        shape = f"{len(topology.clusters)} clusters x {topology.cores_per_cluster} cores"
        yield False, f"platform {self.placement.name} ({shape}), by {self._mapfile.path}"
        yield from ((True, text) for text in self.placement.notices)

    def place(self, name: str | None, namespace: str, executable: str) -> PlacedNode | None:
        """Return the placement of a node to be started; None if it is not in the mapfile.

        Names, and suffixes of duplicate names, follow `manycore run`.
        """
        node = numbered(_launched(self._mapfile.path, name, namespace, executable), self._taken)
        for placed in self.placement.nodes:
            if is_meant(placed.name, node):
                self._note_start(placed, full_node_name(namespace, node.label))
                return placed
        return None

    def _note_start(self, placed: PlacedNode, full_name: str) -> None:
        first = self._started.setdefault(placed.name, full_name)
        if first != full_name:
            expected = "a name that one node of the launch file has"
            found = f"several: {first}, {full_name}"
            path = ("nodes", placed.name)
            raise MapfileError(self._mapfile.document.problem(path, expected, found))

    def environment(self, placed: PlacedNode, launched: Mapping[str, str]) -> dict[str, str]:
        """Return the environment of a node; `launched` is the one given by launch.

        As with `manycore run`, the launch file decides everything that the mapfile leaves open,
        except the placement.
        """
        fixed = {*PLACE_VARIABLES, *self._mapfile.sections.nodes[placed.name].env}
        asked = {
            variable: value
            for variable, value in launched.items()
            if self._before.get(variable) != value and variable not in fixed
        }
        return program_environment({**placed.env, **asked, **self.elsewhere(launched)}, launched)

    def elsewhere(self, launched: Mapping[str, str]) -> dict[str, str]:
        """Return empty place variables if launch starts a node in another ROS domain."""
        return dict.fromkeys(NODE_VARIABLES, "") if is_elsewhere(launched, self._before) else {}

    @property
    def not_started(self) -> list[str]:
        """Nodes of the mapfile that were not started."""
        return [node.name for node in self.placement.nodes if node.name not in self._started]

    @property
    def bridge(self) -> list[NodeProgram]:
        """Bridge processes required by the mapfile."""
        return bridge_programs(self.placement)


def _launched(mapfile: Path, name: str | None, namespace: str, executable: str) -> LaunchedNode:
    return LaunchedNode(
        file=mapfile,
        line=0,
        name=name,
        namespace=namespace,
        package=None,
        executable=executable,
        command=(),
        parameters=(),
        remappings=(),
        arguments=(),
        ros_arguments=(),
        env={},
    )
