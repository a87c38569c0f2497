# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a launch file starts: nodes, the components in them, and what happens at their ends."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rmw_manycore_py.errors import Problem
from rmw_manycore_py.ros.names import full_node_name

ParameterSource = dict[str, Any] | Path


@dataclass(frozen=True)
class Start:
    """When a process starts: with the others, or once another one started or ended.

    `after` is the `serial` of the other one; the delay in seconds counts from then.
    """

    delay_s: float = 0.0
    after: int | None = None
    on_exit: bool = False  # of the other one; else when that starts


@dataclass(frozen=True)
class Respawn:
    """A process is started again when it ends; `max_retries` below 0 is without end."""

    delay_s: float = 0.0
    max_retries: int = -1


@dataclass(frozen=True)
class LaunchedComponent:
    """A node that a container loads from a plugin."""

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
        """The name a mapfile uses: that of the node, else of the plugin's class."""
        return self.name or as_name(self.plugin.rpartition("::")[2])


@dataclass(frozen=True)
class LaunchedNode:
    """A node or executable as a launch file starts it."""

    file: Path
    line: int
    name: str | None
    namespace: str
    package: str | None
    executable: str | None
    command: tuple[str, ...]
    parameters: tuple[ParameterSource, ...]
    remappings: tuple[tuple[str, str], ...]
    arguments: tuple[str, ...]
    ros_arguments: tuple[str, ...]
    env: Mapping[str, str]
    serial: int = 0
    number: int = 1  # of those with the same name
    prefix: tuple[str, ...] = ()
    cwd: str | None = None
    start: Start = Start()
    respawn: Respawn | None = None
    ends_run: bool = False  # what is left is stopped when it ends
    transitions: tuple[int, ...] = ()  # of its lifecycle, once it runs
    components: tuple[LaunchedComponent, ...] = ()
    problem: Problem | None = None  # why it cannot run here

    @property
    def label(self) -> str:
        """The name a mapfile uses: that of the node, else of the executable.

        Of several that would have one name in one namespace, those behind the first have a number.
        """
        program = self.executable or (*self.command, "?")[0]
        label = self.name or as_name(Path(program).name.removesuffix(".py"))
        return label if self.number == 1 else f"{label}_{self.number}"


def numbered(node: LaunchedNode, taken: set[str]) -> LaunchedNode:
    """Return the node with the first number that gives it a name of its own, and take that name."""
    number = 1
    while (full_name := _full_label(replace(node, number=number))) in taken:
        number += 1
    taken.add(full_name)
    return replace(node, number=number)


def _full_label(node: LaunchedNode) -> str:
    return full_node_name(node.namespace, node.label)


def as_name(text: str) -> str:
    """Return a text as the name of a node: letters, digits and underscores."""
    return re.sub(r"\W", "_", text, flags=re.ASCII)
