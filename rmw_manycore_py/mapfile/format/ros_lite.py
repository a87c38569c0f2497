# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Converts the .map list of ROS-lite (its Fig. 7) to the mapfile's form."""

from __future__ import annotations

from typing import Any

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.format.document import Document, KeyPath
from rmw_manycore_py.mapfile.format.validation import describe

# ROS-lite's maps are for the MPPA-256 and have no key for the platform.
_PLATFORM = "bostan"


def from_list(document: Document) -> Document:
    """Return the nodes as a mapping by name; line numbers remain those of the list."""
    result = Document(document.file, {"platform": _PLATFORM, "nodes": {}}, {(): 1})
    problems: list[Problem] = []
    lines: dict[int, dict[KeyPath, int]] = {}
    for (index, *rest), line in ((path, line) for path, line in document.lines.items() if path):
        lines.setdefault(index, {})[tuple(rest)] = line
    for index, entry in enumerate(document.data):
        try:
            name = _add_entry(document, (index,), entry, result)
            result.lines |= {("nodes", name, *rest): n for rest, n in lines[index].items()}
        except MapfileError as error:
            problems += error.problems
    if problems:
        raise MapfileError(*problems)
    return result


def _add_entry(document: Document, path: KeyPath, entry: Any, result: Document) -> str:
    """Add a node to the result and return its name."""
    if not isinstance(entry, dict) or not isinstance(entry.get("name"), str):
        problem = document.problem(path, "an entry with the key 'name'", describe(entry))
        raise MapfileError(problem)
    name: str = entry["name"]
    nodes = result.data["nodes"]
    if name in nodes:
        raise MapfileError(document.problem((*path, "name"), "each name once", f"'{name}' again"))
    node = {key: value for key, value in entry.items() if key != "name"}
    for key in ("publish", "subscribe"):
        node[key] = _join_topics(document, path, node.get(key), node.pop(f"{key}_type", None), key)
    nodes[name] = node
    return name


def _join_topics(
    document: Document, path: KeyPath, topics: Any, types: Any, key: str
) -> dict[str, Any]:
    topics = [] if topics is None else topics
    types = [] if types is None else types
    for name, value in ((key, topics), (f"{key}_type", types)):
        if not isinstance(value, list):
            raise MapfileError(document.problem((*path, name), "a list", describe(value)))
    seen: set[str] = set()
    for index, topic in enumerate(topics):
        if not isinstance(topic, str) or topic in seen:
            expected = "names of topics, each once"
            raise MapfileError(document.problem((*path, key, index), expected, describe(topic)))
        seen.add(topic)
    if len(topics) != len(types):
        expected = f"one type for each topic of '{key}', {len(topics)} in all"
        raise MapfileError(document.problem((*path, f"{key}_type"), expected, str(len(types))))
    return dict(zip(topics, types, strict=True))
