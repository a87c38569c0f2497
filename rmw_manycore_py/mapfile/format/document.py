# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A YAML file as plain data that still knows the line of every key."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from rmw_manycore_py.errors import MapfileError, Problem

KeyPath = tuple[Any, ...]


@dataclass
class Document:
    """Data with the line of each key path; shortened paths give the line of what is around them."""

    file: Path
    data: Any = None
    lines: dict[KeyPath, int] = field(default_factory=dict)

    def line(self, path: KeyPath) -> int:
        """Return the line of a key, or of the nearest thing around it."""
        while path and path not in self.lines:
            path = path[:-1]
        return self.lines.get(path, 1)

    def problem(self, path: KeyPath, expected: str, found: str) -> Problem:
        """Return what is wrong with the key at that path."""
        return Problem(self.file, self.line(path), dotted(path), expected, found)


def dotted(path: KeyPath) -> str:
    """Write a key path as people do: nodes.talker.core."""
    return ".".join(str(part) for part in path)


def read_text(path: Path, problem: Problem | None = None) -> str:
    """Return a file's text; `problem` says who asked for it."""
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "bytes that are not UTF-8"
        raise MapfileError(
            problem or Problem(path, 0, "", "a readable text file", reason)
        ) from error


def read_yaml(path: Path, repeated: Collection[str] = ()) -> Document:
    """Read a YAML file; duplicate keys are errors, all of them reported.

    Mappings of the top-level keys in `repeated` become lists of pairs, whose keys may be equal.
    """
    loader = yaml.SafeLoader(read_text(path))
    try:
        root = loader.get_single_node()
        reader = _Reader(path, loader, repeated)
        document = Document(path, reader.convert(root, ()) if root else None, reader.lines)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = mark.line + 1 if mark else 0
        found = str(error.problem or error.context).removeprefix("but ").removeprefix("found ")
        problem = Problem(path, line, "", "valid YAML", found)
        raise MapfileError(problem) from error
    except yaml.YAMLError as error:
        raise MapfileError(Problem(path, 0, "", "valid YAML", str(error))) from error
    finally:
        loader.dispose()
    if reader.problems:
        raise MapfileError(*reader.problems)
    return document


class _Reader:
    """Turns YAML nodes into data, noting lines and duplicate keys."""

    def __init__(self, file: Path, loader: yaml.SafeLoader, repeated: Collection[str]) -> None:
        self._file = file
        self._repeated = repeated
        self._loader = loader
        self._open: set[int] = set()
        self.lines: dict[KeyPath, int] = {}
        self.problems: list[Problem] = []

    def convert(self, node: yaml.Node, path: KeyPath) -> Any:
        self.lines.setdefault(path, node.start_mark.line + 1)
        if id(node) in self._open:
            found = f"'{dotted(path)}', which contains itself"
            raise yaml.MarkedYAMLError(problem=found, problem_mark=node.start_mark)
        self._open.add(id(node))
        try:
            if isinstance(node, yaml.MappingNode):
                if len(path) == 1 and path[0] in self._repeated:
                    return self._pairs(node, path)
                return self._mapping(node, path)
            if isinstance(node, yaml.SequenceNode):
                return [self.convert(item, (*path, i)) for i, item in enumerate(node.value)]
            value = self._loader.construct_object(node, deep=True)
            if isinstance(value, str) and "\0" in value:
                line, expected = node.start_mark.line + 1, "text without NUL characters"
                problem = Problem(self._file, line, dotted(path), expected, repr(value))
                self.problems.append(problem)
            return value
        finally:
            self._open.discard(id(node))

    def _mapping(self, node: yaml.MappingNode, path: KeyPath) -> dict[Any, Any]:
        first_lines: dict[Any, int] = {}
        for key, key_node in self._keys(node):
            line = key_node.start_mark.line + 1
            if key in first_lines and not _is_none_entry(key, node):
                found = f"'{key}' again; it is already in line {first_lines[key]}"
                self.problems.append(
                    Problem(self._file, line, dotted((*path, key)), "each key once", found)
                )
            first_lines.setdefault(key, line)
        self._loader.flatten_mapping(node)
        data: dict[Any, Any] = {}
        for key_node, value_node in node.value:
            key = self._loader.construct_object(key_node, deep=True)
            here = (*path, key)
            self.lines[here] = key_node.start_mark.line + 1
            data[key] = self.convert(value_node, here)
        return data

    def _pairs(self, node: yaml.MappingNode, path: KeyPath) -> list[tuple[Any, Any]]:
        pairs = []
        for index, (key_node, value_node) in enumerate(node.value):
            key = self._loader.construct_object(key_node, deep=True)
            here = (*path, index)
            value_path = (*here, 1)
            self.lines[here] = self.lines[value_path] = key_node.start_mark.line + 1
            pairs.append((key, self.convert(value_node, value_path)))
        return pairs

    def _keys(self, node: yaml.MappingNode) -> Iterator[tuple[Any, yaml.Node]]:
        for key_node, _ in node.value:
            if key_node.tag == "tag:yaml.org,2002:merge":
                continue
            if not isinstance(key_node, yaml.ScalarNode):
                raise yaml.MarkedYAMLError(
                    problem="a key that is not a scalar", problem_mark=key_node.start_mark
                )
            yield self._loader.construct_object(key_node, deep=True), key_node


def _is_none_entry(key: Any, node: yaml.MappingNode) -> bool:
    """Fig. 8 writes `none:` for an empty entry, more than once in a node as it is printed."""
    return key == "none" and all(
        value.tag == "tag:yaml.org,2002:null" for name, value in node.value if name.value == "none"
    )
