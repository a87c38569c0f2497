# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A mapfile with other places for its nodes; everything else, comments included, stays."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import yaml

from rmw_manycore_py.advice.places import Place
from rmw_manycore_py.errors import ManycoreError

_ALIAS = re.compile(r"\s*:\s*(\*[^\s,}\]]+)")
# Nodes may inherit keys of others, which then change as well.
_MAX_ROUNDS = 4
Keys = dict[str, str]  # text of each value


@dataclass(frozen=True)
class _Edit:
    begin: int
    end: int
    text: str


def rewritten(text: str, places: Mapping[str, Place]) -> str:
    """Return the text of a mapfile with these places of its nodes."""
    before = _values(text)
    wanted = {name: _keys(place, before[name]) for name, place in places.items()}
    keys: dict[str, Keys] = {name: {} for name in wanted}
    for _ in range(_MAX_ROUNDS):
        result = _edited(text, keys)
        found = _values(result)
        missing = {
            (name, key): value
            for name, own in wanted.items()
            for key, value in own.items()
            if found[name].get(key) != yaml.safe_load(value)
        }
        if not missing:
            return result
        for (name, key), value in missing.items():
            keys[name][key] = value
    names = ", ".join(sorted({name for name, _ in missing}))
    raise ManycoreError(f"the places of {names} could not be written: give them keys of their own")


def _keys(place: Place, before: Mapping[str, Any]) -> Keys:
    """Return the keys that a node is to have; what the place leaves open stays as it was."""
    values: dict[str, Any] = {
        "cluster": place.cluster,
        "core": place.core,
        "host_cpu": place.host_cpu,
    }
    keys = {
        name: json.dumps(before.get(name) if value is None else value)
        for name, value in values.items()
    }
    if place.scheduling is None:
        keys["scheduling"] = json.dumps(before.get("scheduling"))
    else:
        policy, priority = place.scheduling.policy, place.scheduling.priority
        keys["scheduling"] = f"{{policy: {policy}, priority: {priority}}}"
    return keys


def _values(text: str) -> dict[str, dict[str, Any]]:
    """Return the keys of each node, inherited ones included."""
    data = yaml.safe_load(text)
    if isinstance(data, list):
        return {entry["name"]: entry for entry in data}
    nodes: dict[str, dict[str, Any]] = data["nodes"]
    return nodes


def _edited(text: str, keys: Mapping[str, Keys]) -> str:
    edits = [
        edit for name, key, node in _nodes(text) for edit in _edits(text, key, node, keys[name])
    ]
    for edit in sorted(edits, key=lambda one: -one.begin):
        text = text[: edit.begin] + edit.text + text[edit.end :]
    return text


def _nodes(text: str) -> Iterator[tuple[str, yaml.Node | None, yaml.MappingNode]]:
    """Yield name, key and value of each node of a mapfile, or of a list, which has no keys."""
    root = yaml.compose(text, Loader=yaml.SafeLoader)
    if isinstance(root, yaml.SequenceNode):
        for entry in root.value:
            own = _own(entry)
            yield own["name"][1].value, None, entry
        return
    assert isinstance(root, yaml.MappingNode)
    nodes = _own(root)["nodes"][1]
    for key, value in nodes.value:
        yield key.value, key, value


def _own(node: yaml.MappingNode) -> dict[str, tuple[yaml.Node, yaml.Node]]:
    """Return keys and values that a mapping does not inherit."""
    return {key.value: (key, value) for key, value in node.value}


def _edits(
    text: str, key: yaml.Node | None, node: yaml.MappingNode, wanted: Keys
) -> Iterator[_Edit]:
    if not wanted:
        return
    if key is not None and node.start_mark.index < key.start_mark.index:  # an alias
        found = _ALIAS.match(text, key.end_mark.index)
        assert found is not None
        line = ", ".join([f"<<: {found[1]}", *_words(wanted)])
        yield _Edit(found.start(1), found.end(1), f"{{{line}}}")
        return
    own = _own(node)
    for name, (_, value) in own.items():
        if name in wanted:
            begin, end = value.start_mark.index, value.end_mark.index
            end = begin + len(text[begin:end].rstrip())
            yield _Edit(begin, end, wanted[name])
    words = _words({name: value for name, value in wanted.items() if name not in own})
    if words:
        yield _insertion(text, node, own, words)


def _words(keys: Keys) -> list[str]:
    return [f"{name}: {value}" for name, value in keys.items()]


def _insertion(
    text: str,
    node: yaml.MappingNode,
    own: Mapping[str, tuple[yaml.Node, yaml.Node]],
    words: list[str],
) -> _Edit:
    """Return where new keys go: behind the cluster, else in front."""
    begin = node.start_mark.index
    if node.flow_style:
        if "cluster" in own:
            at = own["cluster"][1].end_mark.index
            return _Edit(at, at, "".join(f", {word}" for word in words))
        return _Edit(begin + 1, begin + 1, "".join(f"{word}, " for word in words))
    if "cluster" not in own:
        indent = " " * node.start_mark.column
        return _Edit(begin, begin, "".join(f"{word}\n{indent}" for word in words))
    key, value = own["cluster"]
    indent = " " * key.start_mark.column
    at = text.find("\n", value.end_mark.index)
    at = len(text) if at < 0 else at
    return _Edit(at, at, "".join(f"\n{indent}{word}" for word in words))
