# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""State while a launch file is read, and the nodes found in it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from rmw_manycore_py.mapfile.launch_file.launched import (
    GivenByName,
    LaunchedComponent,
    LaunchedNode,
    ParameterSource,
    Start,
    numbered,
)


@dataclass
class Scope:
    """State restored at the end of a scoped group."""

    configurations: dict[str, Any] = field(default_factory=dict)
    environment: dict[str, str] = field(default_factory=dict)
    unset: frozenset[str] = frozenset()

    def copy(self) -> Scope:
        """Return a copy that shares its lists with the original, as under launch."""
        return Scope(dict(self.configurations), dict(self.environment), self.unset)


class NodeSettings:
    """Settings of later nodes; launch_ros keeps them among the launch configurations.

    They end where these are restored, reset or cleared. An existing list is extended in place: what
    a group adds to it outlasts the group.
    """

    def __init__(self, configurations: dict[str, Any]) -> None:
        self._configurations = configurations

    @property
    def namespace(self) -> str:
        """Namespace pushed so far; empty if none was."""
        return str(self._configurations.get("ros_namespace", ""))

    @namespace.setter
    def namespace(self, value: str) -> None:
        self._configurations["ros_namespace"] = value

    @property
    def parameters(self) -> list[ParameterSource]:
        """Parameters and parameter files."""
        found = self._configurations.get("global_params", [])
        return [
            GivenByName({one[0]: one[1]}) if isinstance(one, tuple) else Path(os.path.abspath(one))
            for one in found
        ]

    @property
    def remappings(self) -> list[tuple[str, str]]:
        """Remappings."""
        found: list[tuple[str, str]] = self._configurations.get("ros_remaps", [])
        return found

    def add_parameters(self, source: tuple[str, Any] | str) -> None:
        """Add a name with its value, or a file."""
        self._configurations.setdefault("global_params", []).append(source)

    def add_remapping(self, source: str, target: str) -> None:
        """Add a remapping."""
        self._configurations.setdefault("ros_remaps", []).append((source, target))


@dataclass(frozen=True)
class Later:
    """Deferred actions."""

    start: Start
    file: Path
    visit: Callable[[], None]


class LaunchContext:
    """State of reading; Python launch files receive it as their LaunchContext."""

    def __init__(self, file: Path = Path(), arguments: Mapping[str, str] | None = None) -> None:
        self.file = file
        self.scope = Scope(dict(arguments or {}))
        self.nodes: list[LaunchedNode] = []
        self.loads: list[tuple[str, LaunchedComponent]] = []
        self.serials: dict[int, tuple[int, Any]] = {}  # of process actions, by id
        self.start = Start()
        self.later: list[Later] = []
        self.handlers: list[Any] = []
        self.ending: set[int] = set()
        self.transitions: dict[int, list[int]] = {}
        self.locals = SimpleNamespace()
        self.environments: list[dict[str, str]] = []
        self.configurations: list[dict[str, Any]] = []
        self.notices: list[str] = []
        self.declared: set[str] = set()
        self.depth = 0
        self.files = 0

    @property
    def launch_configurations(self) -> dict[str, Any]:
        """Launch arguments, values set by `let`, and settings of later nodes."""
        return self.scope.configurations

    @property
    def settings(self) -> NodeSettings:
        """Settings of later nodes at this point of the launch file."""
        return NodeSettings(self.scope.configurations)

    @property
    def environment(self) -> dict[str, str]:
        """Environment at this point of the launch file."""
        outer = {k: v for k, v in os.environ.items() if k not in self.scope.unset}
        return {**outer, **self.scope.environment}

    def serial(self, action: Any) -> int:
        """Return the serial of the process an action starts; also before the action is executed."""
        return self.serials.setdefault(id(action), (len(self.serials) + 1, action))[0]

    def perform_substitution(self, substitution: Any) -> str:
        """Return the text of a substitution."""
        return str(substitution.perform(self))

    def notice(self, line: int, text: str) -> None:
        """Record a difference from the behaviour under ros2 launch."""
        place = f"{self.file}:{line}" if line else str(self.file)
        if (text := f"{place}: {text}") not in self.notices:
            self.notices.append(text)

    def result(self) -> list[LaunchedNode]:
        """Return the nodes, completed with settings found elsewhere in the launch file."""
        containers: dict[str, list[LaunchedComponent]] = {}
        for container, component in self.loads:
            containers.setdefault(container, []).append(component)
        nodes: list[LaunchedNode] = []
        taken: set[str] = set()
        for node in self.nodes:
            full_name = join_namespace(node.namespace, node.label)
            nodes.append(
                replace(
                    numbered(node, taken),
                    components=tuple(containers.pop(full_name, ())),
                    ends_run=node.serial in self.ending,
                    transitions=tuple(self.transitions.get(node.serial, ())),
                )
            )
        for name, components in containers.items():
            for one in components:
                place = f"{one.file}:{one.line}"
                self.notices.append(
                    f"{place}: '{one.label}' is not loaded: no container {name} is started here"
                )
        return nodes

    def finish(self) -> None:
        """Execute timers and event handlers with the final settings."""
        while self.later:
            later = self.later.pop(0)
            self.start = later.start
            with self.reading(later.file):
                later.visit()
        self.start = Start()

    @contextmanager
    def scoped(self) -> Iterator[None]:
        """Restore the scope at the end of the block."""
        outer, self.scope = self.scope, self.scope.copy()
        try:
            yield
        finally:
            self.scope = outer

    @contextmanager
    def reading(self, file: Path) -> Iterator[None]:
        """Set the launch file that is being read."""
        outer, self.file = self.file, file
        try:
            yield
        finally:
            self.file = outer


def join_namespace(base: str, namespace: str) -> str:
    """Return `namespace` below `base`, or unchanged if it is absolute."""
    if namespace.startswith("/"):
        return namespace.rstrip("/") or "/"
    return "/" + "/".join(part for part in (base.strip("/"), namespace.strip("/")) if part)
