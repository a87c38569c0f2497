# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the runner needs to start a node."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py.launch.processes.environment import program_environment
from rmw_manycore_py.mapfile.placing.placement import NO_RULES, LaunchRules, PlacedNode
from rmw_manycore_py.platform.topology import Core, HostCpu, as_host_cpu
from rmw_manycore_py.process.scheduling import Scheduling


@dataclass(frozen=True)
class NodeProgram:
    """One node as a process: command line, complete environment, core.

    A `supervised` process serves the nodes: it calls `report_ready` when it has come up, is
    restarted whenever it ends, and does not keep a run alive.
    """

    name: str
    command: tuple[str, ...]
    environment: Mapping[str, str]
    core: Core
    host_cpus: tuple[int, ...]  # empty: all CPUs of the runner
    directory: Path | None = None
    supervised: bool = False
    rules: LaunchRules = NO_RULES
    repeats: bool = False  # start whenever the node of `rules.after` starts
    terminal: bool = False  # give it a terminal for `manycore attach`
    scheduling: Scheduling | None = None  # None: inherit from the runner

    @property
    def host_cpu(self) -> HostCpu:
        """Host CPUs as reported in events."""
        return as_host_cpu(self.host_cpus)

    @classmethod
    def of(cls, node: PlacedNode, parameters: Path) -> NodeProgram:
        """Return the program of a placed node; its generated files are in `parameters`."""
        return cls(
            name=node.name,
            command=tuple(node.command(parameters)),
            environment=program_environment(node.env),
            core=node.place,
            host_cpus=(node.host_cpu,),
            directory=node.cwd,
            rules=node.rules,
            terminal=node.terminal,
            scheduling=node.scheduling,
        )
