# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A YAML file as plain data with the line of every key."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.format.bounded_yaml import MAX_BYTES, BoundedLoader, BoundError

KeyPath = tuple[Any, ...]
# How to read the text of unquoted scalars at a path; None: as YAML does.
Reading = Callable[[KeyPath], Callable[[str], Any] | None]


@dataclass
class Document:
    """Data with the line of each key path; unknown paths map to the line of their parent."""

    file: Path
    data: Any = None
    lines: dict[KeyPath, int] = field(default_factory=dict)

    def line(self, path: KeyPath) -> int:
        """Return the line of a key, or of its nearest known parent."""
        while path and path not in self.lines:
            path = path[:-1]
        return self.lines.get(path, 1)

    def problem(self, path: KeyPath, expected: str, found: str) -> Problem:
        """Return a Problem with the key at that path."""
        return Problem(self.file, self.line(path), dotted(path), expected, found)


def dotted(path: KeyPath) -> str:
    """Format a key path as nodes.talker.core."""
    return ".".join(str(part) for part in path)


def read_text(path: Path, problem: Problem | None = None) -> str:
    """Return a file's text; `problem` replaces the default problem if it cannot be read."""
    content = read_bytes(path, problem)
    try:
        return content.decode("utf-8")
    except ValueError as error:
        raise _unreadable(path, problem, "bytes that are not UTF-8") from error


def read_bytes(path: Path, problem: Problem | None = None) -> bytes:
    """Return what is in a text file, of any encoding; see `read_text`."""
    try:
        with path.open("rb") as file:
            content = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:  # ValueError: a path with a zero byte
        raise _unreadable(path, problem, getattr(error, "strerror", None) or str(error)) from error
    if len(content) > MAX_BYTES:
        raise MapfileError(Problem(path, 0, "", f"at most {MAX_BYTES} bytes", "more"))
    return content


def _unreadable(path: Path, problem: Problem | None, reason: str) -> MapfileError:
    return MapfileError(problem or Problem(path, 0, "", "a readable text file", reason))


def read_yaml(
    path: Path, repeated: Collection[str] = (), reading: Reading = lambda _: None
) -> Document:
    """Read a YAML file; see `parse_yaml`."""
    return parse_yaml(read_text(path), path, repeated, reading)


def parse_yaml(
    text: str,
    path: Path,
    repeated: Collection[str] = (),
    reading: Reading = lambda _: None,
) -> Document:
    """Parse a YAML text; report all duplicate keys in one error.

    The mappings of top-level keys in `repeated` become lists of pairs and may repeat keys.
    """
    loader = None
    try:
        loader = BoundedLoader(text)
        root = loader.get_single_node()
        reader = _Reader(path, loader, repeated, reading)
        document = Document(path, reader.convert(root, ()) if root else None, reader.lines)
    except yaml.MarkedYAMLError as error:
        raise MapfileError(_problem(path, error)) from error
    except yaml.reader.ReaderError as error:
        line = text.count("\n", 0, error.position) + 1
        found = f"'{chr(error.character)}'"
        expected = "text of printable characters"
        raise MapfileError(Problem(path, line, "", expected, found)) from error
    except (ValueError, OverflowError) as error:  # numbers in escapes and directives
        line = loader.line + 1 if loader else 0
        raise MapfileError(
            Problem(path, line, "", "valid YAML", "a number that is too large")
        ) from error
    finally:
        if loader:
            loader.dispose()
    if reader.problems:
        raise MapfileError(*reader.problems)
    return document


def _problem(path: Path, error: yaml.MarkedYAMLError, key: str = "") -> Problem:
    place = error.problem_mark or error.context_mark
    line = place.line + 1 if place else 0
    found = str(error.problem or error.context).removeprefix("but ").removeprefix("found ")
    expected = error.expected if isinstance(error, BoundError) else "valid YAML"
    return Problem(path, line, key, expected, found)


class _Reader:
    """Converts YAML nodes to data; records lines and duplicate keys."""

    def __init__(
        self,
        file: Path,
        loader: BoundedLoader,
        repeated: Collection[str],
        reading: Reading,
    ) -> None:
        self._file = file
        self._repeated = repeated
        self._reading = reading
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
            assert isinstance(node, yaml.ScalarNode)
            return self._scalar(node, path)
        finally:
            self._open.discard(id(node))

    def _mapping(self, node: yaml.MappingNode, path: KeyPath) -> dict[Any, Any]:
        first_lines: dict[Any, int] = {}
        for key_node, _ in node.value:
            if key_node.tag == "tag:yaml.org,2002:merge":
                continue
            key, line = self._key(key_node), key_node.start_mark.line + 1
            if key in first_lines and not _is_none_entry(key, node):
                found = f"'{key}' again; it is already in line {first_lines[key]}"
                self.problems.append(
                    Problem(self._file, line, dotted((*path, key)), "each key once", found)
                )
            first_lines.setdefault(key, line)
        self._loader.flatten_mapping(node)
        data: dict[Any, Any] = {}
        for key_node, value_node in node.value:
            key = self._key(key_node)
            here = (*path, key)
            self.lines[here] = key_node.start_mark.line + 1
            data[key] = self.convert(value_node, here)
        return data

    def _pairs(self, node: yaml.MappingNode, path: KeyPath) -> list[tuple[Any, Any]]:
        pairs = []
        for index, (key_node, value_node) in enumerate(node.value):
            key = self._key(key_node)
            here = (*path, index)
            value_path = (*here, 1)
            self.lines[here] = self.lines[value_path] = key_node.start_mark.line + 1
            pairs.append((key, self.convert(value_node, value_path)))
        return pairs

    def _key(self, node: yaml.Node) -> Any:
        if not isinstance(node, yaml.ScalarNode):
            raise yaml.MarkedYAMLError(
                problem="a key that is not a scalar", problem_mark=node.start_mark
            )
        return self._loader.scalar(node)

    def _scalar(self, node: yaml.ScalarNode, path: KeyPath) -> Any:
        read = self._reading(path) if self._loader.is_untyped(node) else None
        if read is not None:
            return None if node.tag.endswith(":null") else read(node.value)
        try:
            return self._loader.scalar(node)
        except BoundError as error:
            self.problems.append(_problem(self._file, error, dotted(path)))
            return None


def _is_none_entry(key: Any, node: yaml.MappingNode) -> bool:
    """Return whether a key is `none:`, which Fig. 8 uses, repeatedly, for an empty entry."""
    return key == "none" and all(
        value.tag == "tag:yaml.org,2002:null" for name, value in node.value if name.value == "none"
    )
