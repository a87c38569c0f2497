# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What is known while a launch file is read, and what is found in it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from rmw_manycore_py.errors import Problem
from rmw_manycore_py.mapfile.launch_file.launched import (
    LaunchedComponent,
    LaunchedNode,
    ParameterSource,
    Start,
    numbered,
)


class RefusedError(Exception):
    """What a launch file says cannot be honoured; the action around it knows file and line."""

    def __init__(self, expected: str, found: str, key: str = "") -> None:
        super().__init__(f"expected {expected}, found {found}")
        self.expected, self.found, self.key = expected, found, key

    def at(self, file: Path, line: int) -> Problem:
        """Return the same with its place."""
        return Problem(file, line, self.key, self.expected, self.found)


class NotInstalledError(RefusedError):
    """A package, program or file is not on this machine; only what needs it is concerned."""


class MissingText(str):
    """The value of a launch argument that is not known for want of something; `error` says what."""

    error: NotInstalledError

    @classmethod
    def of(cls, error: NotInstalledError) -> MissingText:
        """Return the value that raises `error` where it is used."""
        text = cls(error.found)
        text.error = error
        return text


@dataclass
class Scope:
    """What a scoped group restores when it ends."""

    configurations: dict[str, str] = field(default_factory=dict)
    environment: dict[str, str] = field(default_factory=dict)
    namespace: str = ""
    parameters: tuple[ParameterSource, ...] = ()
    remappings: tuple[tuple[str, str], ...] = ()
    unset: frozenset[str] = frozenset()

    def copy(self) -> Scope:
        """Return a scope that can be changed without changing this one."""
        return Scope(
            dict(self.configurations),
            dict(self.environment),
            self.namespace,
            self.parameters,
            self.remappings,
            self.unset,
        )


@dataclass(frozen=True)
class Later:
    """Actions that are not executed at once."""

    start: Start
    file: Path
    visit: Callable[[], None]


class LaunchContext:
    """The state of reading; launch files in Python get it under this name too."""

    def __init__(self, file: Path = Path(), arguments: Mapping[str, str] | None = None) -> None:
        self.file = file
        self.scope = Scope(dict(arguments or {}))
        self.nodes: list[LaunchedNode] = []
        self.loads: list[tuple[str, LaunchedComponent]] = []
        self.serials: dict[int, tuple[int, Any]] = {}  # of actions that start processes, by id
        self.start = Start()
        self.later: list[Later] = []
        self.handlers: list[Any] = []
        self.ending: set[int] = set()
        self.transitions: dict[int, list[int]] = {}
        self.locals = SimpleNamespace()
        self.environments: list[dict[str, str]] = []
        self.configurations: list[dict[str, str]] = []
        self.notices: list[str] = []
        self.missing: set[Path] = set()  # prefixes of packages that are not installed
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
        outer = {k: v for k, v in os.environ.items() if k not in self.scope.unset}
        return {**outer, **self.scope.environment}

    def serial(self, action: Any) -> int:
        """Return the number of the process that an action starts, also before it is executed."""
        return self.serials.setdefault(id(action), (len(self.serials) + 1, action))[0]

    def perform_substitution(self, substitution: Any) -> str:
        """Return the text of a substitution."""
        return str(substitution.perform(self))

    def notice(self, line: int, text: str) -> None:
        """Note something that does not act here as it does under ros2 launch."""
        place = f"{self.file}:{line}" if line else str(self.file)
        if (text := f"{place}: {text}") not in self.notices:
            self.notices.append(text)

    def is_missing(self, path: Path) -> bool:
        """Tell whether a path leads into a package that is not installed."""
        return any(prefix in path.parents for prefix in self.missing)

    def result(self) -> list[LaunchedNode]:
        """Return the nodes with what was found of them elsewhere in the launch file."""
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
        """Do what timers and event handlers do, with what is set when all else is done."""
        while self.later:
            later = self.later.pop(0)
            self.start = later.start
            with self.reading(later.file):
                later.visit()
        self.start = Start()

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
