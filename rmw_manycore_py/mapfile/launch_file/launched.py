# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Result of reading a launch file: nodes, components, and what follows their exits."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from rmw_manycore_py.errors import Problem
from rmw_manycore_py.ros.names import full_node_name


class ForAllNodes(dict[str, Any]):
    """Parameters that launch gives to all nodes of a process, by -p."""


@dataclass(frozen=True)
class ExpandedFile:
    """A parameter file with its substitutions performed."""

    file: Path
    text: str


ParameterSource = dict[str, Any] | Path | ExpandedFile


class GivenByName(ForAllNodes):
    """Parameters of `set_parameter`, which launch writes to the command line as Python prints them.

    An array is a tuple to launch_ros; rcl reads its `(1, 2)` as a text. Components get the tuple.
    """


@dataclass(frozen=True)
class Start:
    """Start condition of a process: at once, or after another one has started or ended.

    `after` is the `serial` of the other process; the delay in seconds counts from its start or end.
    """

    delay_s: float = 0.0
    after: int | None = None
    on_exit: bool = False  # after the end of the other one; else after its start


@dataclass(frozen=True)
class Respawn:
    """Restart of a process when it ends; a negative `max_retries` means unlimited."""

    delay_s: float = 0.0
    max_retries: int = -1


@dataclass(frozen=True)
class LaunchedComponent:
    """A component loaded into a container."""

    file: Path
    line: int
    package: str
    plugin: str
    name: str | None
    namespace: str
    parameters: tuple[ParameterSource, ...] = ()
    remappings: tuple[tuple[str, str], ...] = ()
    extra_arguments: tuple[ParameterSource, ...] = ()

    @property
    def label(self) -> str:
        """Name in the mapfile: that of the node, else of the plugin's class."""
        return self.name or as_name(self.plugin.rpartition("::")[2])


@dataclass(frozen=True)
class LaunchedNode:
    """A node or executable started by a launch file."""

    file: Path
    line: int
    name: str | None
    namespace: str
    package: str | None = None
    executable: str | None = None
    command: tuple[str, ...] = ()
    parameters: tuple[ParameterSource, ...] = ()
    remappings: tuple[tuple[str, str], ...] = ()
    arguments: tuple[str, ...] = ()
    ros_arguments: tuple[str, ...] = ()
    env: Mapping[str, str] = field(default_factory=dict)
    is_fully_named: bool = False  # name and namespace are given: launch addresses its values to it
    serial: int = 0
    number: int = 1  # among nodes of the same name
    prefix: tuple[str, ...] = ()
    cwd: str | None = None
    start: Start = Start()
    respawn: Respawn | None = None
    ends_run: bool = False  # its end stops the run
    transitions: tuple[int, ...] = ()  # lifecycle transitions after its start
    components: tuple[LaunchedComponent, ...] = ()
    problem: Problem | None = None  # why it cannot run on this machine

    @property
    def label(self) -> str:
        """Name in the mapfile: that of the node, else of the executable.

        Duplicates within a namespace get a numeric suffix, except the first.
        """
        program = self.executable or (*self.command, "?")[0]
        label = self.name or as_name(Path(program).name.removesuffix(".py"))
        return label if self.number == 1 else f"{label}_{self.number}"


def numbered(node: LaunchedNode, taken: set[str]) -> LaunchedNode:
    """Return the node with the first number that makes its name unique; add the name to `taken`."""
    number = 1
    while (full_name := _full_label(replace(node, number=number))) in taken:
        number += 1
    taken.add(full_name)
    return replace(node, number=number)


def _full_label(node: LaunchedNode) -> str:
    return full_node_name(node.namespace, node.label)


def as_name(text: str) -> str:
    """Convert a text to a valid node name: letters, digits and underscores."""
    return re.sub(r"\W", "_", text, flags=re.ASCII)
