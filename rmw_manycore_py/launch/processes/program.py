# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the runner needs to know of a node: how it is started, and where."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py.launch.processes.environment import program_environment
from rmw_manycore_py.mapfile.placing.placement import NO_RULES, LaunchRules, PlacedNode
from rmw_manycore_py.scheduling import Scheduling
from rmw_manycore_py.topology import Core, HostCpu, as_host_cpu


@dataclass(frozen=True)
class NodeProgram:
    """One node as a process: its command line, its whole environment, its core.

    A `supervised` one serves the others: it calls `report_ready` once it has come up, it is started
    again whenever it ends, and a run is over without it.
    """

    name: str
    command: tuple[str, ...]
    environment: Mapping[str, str]
    core: Core
    host_cpus: tuple[int, ...]  # none: all that the runner may use
    directory: Path | None = None
    supervised: bool = False
    rules: LaunchRules = NO_RULES
    repeats: bool = False  # starts each time that the node of `rules.after` does
    terminal: bool = False  # its streams are a terminal that `manycore attach` attaches to
    scheduling: Scheduling | None = None  # None: as the runner itself

    @property
    def host_cpu(self) -> HostCpu:
        """The host CPUs as events report them."""
        return as_host_cpu(self.host_cpus)

    @classmethod
    def of(cls, node: PlacedNode) -> NodeProgram:
        """Return the program of a node that a mapfile places."""
        return cls(
            name=node.name,
            command=tuple(node.argv),
            environment=program_environment(node.env),
            core=node.place,
            host_cpus=(node.host_cpu,),
            directory=node.cwd,
            rules=node.rules,
            terminal=node.terminal,
            scheduling=node.scheduling,
        )
