# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The imports of Python packages, read from their source.

Every import statement counts, also those under TYPE_CHECKING and inside functions.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

Graph = Mapping[str, set[str]]

# Each module in this package is its own room; everywhere else a directory is one room.
ROOT_PACKAGE = "rmw_manycore_py"


def modules_in(roots: Iterable[Path]) -> dict[str, Path]:
    """Return the path of each importable module below these roots, by its dotted name."""
    return {_name_of(file, root): file for root in roots for file in _sources(root)}


def _sources(root: Path) -> Iterator[Path]:
    yield from root.glob("*.py")
    for package in root.glob("*/__init__.py"):
        yield from (file for file in package.parent.rglob("*") if file.suffix in {".py", ".pyi"})


def _name_of(file: Path, root: Path) -> str:
    return ".".join(file.relative_to(root).with_suffix("").parts).removesuffix(".__init__")


def imports_of(modules: Mapping[str, Path]) -> dict[str, set[str]]:
    """Return for each module the others that it imports."""
    return {
        name: {known for imported in _imported(name, file) if (known := _known(imported, modules))}
        for name, file in modules.items()
    }


def _imported(name: str, file: Path) -> Iterator[str]:
    """Yield the dotted name of each thing that a file imports, module or not."""
    folder = name if file.stem == "__init__" else name.rpartition(".")[0]
    for statement in ast.walk(ast.parse(file.read_text())):
        if isinstance(statement, ast.Import):
            yield from (alias.name for alias in statement.names)
        elif isinstance(statement, ast.ImportFrom):
            parents = folder.split(".")[: len(folder.split(".")) - statement.level + 1]
            base = [*(parents if statement.level else []), *filter(None, [statement.module])]
            yield from (".".join([*base, alias.name]) for alias in statement.names)


def _known(imported: str, modules: Mapping[str, Path]) -> str:
    """Return the module that an import takes something from, "" if it is not one of these."""
    while imported and imported not in modules:
        imported = imported.rpartition(".")[0]
    return imported


def rooms_of(modules: Mapping[str, Path]) -> dict[str, str]:
    """Return the room of each module."""
    rooms = {}
    for name, file in modules.items():
        folder = name if file.stem == "__init__" else name.rpartition(".")[0]
        rooms[name] = name if folder in ("", ROOT_PACKAGE) else folder
    return rooms


def between_rooms(imports: Graph, rooms: Mapping[str, str]) -> dict[str, set[str]]:
    """Return for each room the other rooms that it imports from."""
    graph: dict[str, set[str]] = {room: set() for room in rooms.values()}
    for name, imported in imports.items():
        graph[rooms[name]] |= {rooms[other] for other in imported} - {rooms[name]}
    return graph


def cycle(graph: Graph) -> list[str]:
    """Return the names along one cycle, the first one repeated at its end; [] without a cycle."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        found: list[str] = error.args[1]
        return found[::-1]
    return []
