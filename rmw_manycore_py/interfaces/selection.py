# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Selects the definitions to build, their order, and their dependencies."""

from __future__ import annotations

import importlib.util
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise
from pathlib import Path

from rmw_manycore_interfaces import hash_of
from rmw_manycore_py.errors import EXIT_BAD_INPUT, DefinitionError, ManycoreError, Problem
from rmw_manycore_py.interfaces.definition import Definition
from rmw_manycore_py.interfaces.sources import Source
from rmw_manycore_py.ros import ament

# Structures generated per definition: messages, requests, responses, events.
_STRUCTURES = {"msg": 1, "srv": 3, "action": 10}


@dataclass(frozen=True)
class Part:
    """Part of a package to build."""

    package: str
    directory: Path
    definitions: tuple[Definition, ...]
    available: int  # number of definitions in the package
    needed: frozenset[str]  # packages referred to
    share_of_code: float  # of the code of the whole package

    @property
    def is_whole(self) -> bool:
        """Return whether the whole package is built."""
        return len(self.definitions) == self.available


def select(sources: Mapping[str, Source], only: Collection[str]) -> list[Part]:
    """Return what to build of the sources, in dependency order.

    :param only: build these types and their dependencies; empty: all.
    :raises DefinitionError: for references to unknown types, and for cycles.
    """
    types = _Types(sources)
    chosen = _closure(types, only) if only else set(types.local)
    problems = [
        *_missing(types, chosen),
        *_cycles({name: _references(types, name) for name in sorted(chosen)}, types),
    ]
    if problems:
        raise DefinitionError(*problems)
    parts = {p: _part(s, chosen) for p, s in sources.items()}
    parts = {package: part for package, part in parts.items() if part.definitions}
    for package, part in parts.items():
        _check_name(package, part)
    return [parts[package] for package in _order(parts)]


class _Types:
    """Location of each type's definition."""

    def __init__(self, sources: Mapping[str, Source]) -> None:
        self.sources = sources
        self.local = {n: d for source in sources.values() for n, d in source.definitions.items()}

    def is_local(self, user: str, name: str) -> bool:
        """Return whether a type used by `user` is taken from the sources.

        An installed package takes precedence at run time, so it is also used for building.
        """
        package = name.split("/")[0]
        if package == user.split("/")[0]:
            return True
        return name in self.local and not ament.is_installed(package)

    def exists(self, user: str, name: str) -> bool:
        """Return whether a type used by `user` is defined anywhere."""
        return name in self.local if self.is_local(user, name) else hash_of(name) is not None


def _closure(types: _Types, only: Collection[str]) -> set[str]:
    for name in only:
        if name not in types.local:
            alike = ", ".join(sorted(types.local)[:8])
            text = f"--only {name}: expected a type of the packages, such as {alike}"
            raise ManycoreError(text, EXIT_BAD_INPUT)
    chosen: set[str] = set()
    pending = list(only)
    while pending:
        name = pending.pop()
        if name not in chosen:
            chosen.add(name)
            pending += _references(types, name)
    return chosen


def _references(types: _Types, name: str) -> list[str]:
    """Return the references of a type that have to be built, too."""
    found = types.local[name].references
    return [other for other in found if types.is_local(name, other) and other in types.local]


def _missing(types: _Types, chosen: Collection[str]) -> Iterator[Problem]:
    for name in sorted(chosen):
        definition = types.local[name]
        for other, line in definition.references.items():
            if types.exists(name, other):
                continue
            package = other.split("/")[0]
            known = types.sources.get(package) or ament.interfaces(package)
            has = f"a package '{package}' without it" if known else f"no package '{package}'"
            expected = f"{other} in the paths, built before or installed"
            yield Problem(definition.file, line, "", expected, has)


def _cycles(graph: Mapping[str, list[str]], types: _Types) -> list[Problem]:
    """Return the edges that close a cycle of types or packages."""
    edges: dict[tuple[str, str], tuple[Definition, int]] = {}
    packages: dict[str, set[str]] = {}
    for name, others in graph.items():
        for other in others:
            definition = types.local[name]
            place = (definition, definition.references[other])
            edges[name, other] = place
            here, there = name.split("/")[0], other.split("/")[0]
            if here != there:
                packages.setdefault(here, set()).add(there)
                edges.setdefault((here, there), place)
    for nodes in (graph, packages):
        try:
            TopologicalSorter(nodes).prepare()
        except CycleError as error:
            around = error.args[1][::-1]
            text = " -> ".join(around)
            problems = []
            for here, there in pairwise(around):
                definition, line = edges[here, there]
                file = definition.file
                problems.append(Problem(file, line, there, "no cycle of definitions", text))
            return problems
    return []


def _part(source: Source, chosen: Collection[str]) -> Part:
    definitions = tuple(d for name, d in sorted(source.definitions.items()) if name in chosen)
    needed = {other.split("/")[0] for d in definitions for other in d.references}
    return Part(
        package=source.package,
        directory=source.directory,
        definitions=definitions,
        available=source.available,
        needed=frozenset(needed - {source.package}),
        share_of_code=_structures(definitions) / _structures(source.definitions.values()),
    )


def _structures(definitions: Iterable[Definition]) -> int:
    return sum(_STRUCTURES[definition.kind] for definition in definitions)


def _order(parts: Mapping[str, Part]) -> Iterable[str]:
    graph = {
        package: [
            other for other in sorted(part.needed & parts.keys()) if not ament.is_installed(other)
        ]
        for package, part in sorted(parts.items())
    }
    return TopologicalSorter(graph).static_order()


def _check_name(package: str, part: Part) -> None:
    """Raise an error if the package name is that of a Python module without interfaces."""
    if ament.interfaces(package):
        return
    spec = importlib.util.find_spec(package)
    if spec is not None and spec.origin is not None:
        expected = "a name that no Python module has"
        found = f"'{package}', which is {spec.origin}"
        raise DefinitionError(Problem(part.directory, 0, "name", expected, found))
