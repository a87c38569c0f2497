# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What is known while a launch file is read, and what is found in it."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rmw_manycore_py.errors import Problem

ParameterSource = dict[str, Any] | Path


class RefusedError(Exception):
    """What a launch file says cannot be honoured; the action around it knows file and line."""

    def __init__(self, expected: str, found: str, key: str = "") -> None:
        super().__init__(f"expected {expected}, found {found}")
        self.expected, self.found, self.key = expected, found, key

    def at(self, file: Path, line: int) -> Problem:
        """Return the same with its place."""
        return Problem(file, line, self.key, self.expected, self.found)


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

    @property
    def label(self) -> str:
        """The name a mapfile uses: that of the node, else of the executable."""
        return self.name or self.executable or Path(self.command[0]).name


@dataclass
class Scope:
    """What a scoped group restores when it ends."""

    configurations: dict[str, str] = field(default_factory=dict)
    environment: dict[str, str] = field(default_factory=dict)
    namespace: str = ""
    parameters: tuple[ParameterSource, ...] = ()
    remappings: tuple[tuple[str, str], ...] = ()

    def copy(self) -> Scope:
        """Return a scope that can be changed without changing this one."""
        return Scope(
            dict(self.configurations),
            dict(self.environment),
            self.namespace,
            self.parameters,
            self.remappings,
        )


class LaunchContext:
    """The state of reading; launch files in Python get it under this name too."""

    def __init__(self, file: Path, arguments: Mapping[str, str]) -> None:
        self.file = file
        self.scope = Scope(dict(arguments))
        self.nodes: list[LaunchedNode] = []
        self.notices: list[str] = []
        self.declared: set[str] = set()
        self.depth = 0
        self.files = 0

    @property
    def launch_configurations(self) -> dict[str, str]:
        """The launch arguments and what `let` set."""
        return self.scope.configurations

    @property
    def environment(self) -> dict[str, str]:
        """The environment at this point of the launch file."""
        return {**os.environ, **self.scope.environment}

    def perform_substitution(self, substitution: Any) -> str:
        """Return the text of a substitution."""
        return str(substitution.perform(self))

    def notice(self, line: int, text: str) -> None:
        """Note something that does not act here as it does under ros2 launch."""
        self.notices.append(f"{self.file}:{line}: {text}")

    @contextmanager
    def scoped(self) -> Iterator[None]:
        """Undo on leaving what was set inside."""
        outer, self.scope = self.scope, self.scope.copy()
        try:
            yield
        finally:
            self.scope = outer

    @contextmanager
    def reading(self, file: Path) -> Iterator[None]:
        """Make `file` the launch file that is being read."""
        outer, self.file = self.file, file
        try:
            yield
        finally:
            self.file = outer


def join_namespace(base: str, namespace: str) -> str:
    """Return `namespace` below `base`, or itself where it is absolute."""
    if namespace.startswith("/"):
        return namespace.rstrip("/") or "/"
    return "/" + "/".join(part for part in (base.strip("/"), namespace.strip("/")) if part)
