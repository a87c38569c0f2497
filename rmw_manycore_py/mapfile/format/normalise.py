# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Converts the spellings of the papers to the form of the model, with a notice for each."""

from __future__ import annotations

from typing import Any

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.format.document import Document, KeyPath, dotted
from rmw_manycore_py.ros.ament import canonical_type

_TOPIC_KEYS = (
    *("topic_in", "topic_to", "publish", "subscribe"),
    *("service_in", "service_to", "action_in", "action_to"),
)
_EMPTIED_BY_NONE = (*_TOPIC_KEYS, "param_file", "param_path", "parameters", "remappings")


def normalise(document: Document) -> list[str]:
    """Rewrite the document in place; return a notice per corrected spelling."""
    notices: list[str] = []
    data = document.data
    if isinstance(data.get("platform"), str):
        data["platform"] = {"profile": data["platform"]}
    for name, topic in _mapping(data.get("topics")).items():
        if isinstance(topic, dict):
            _normalise_type(document, topic, ("topics", name, "type"), notices)
    for name, node in _mapping(data.get("nodes")).items():
        if isinstance(node, dict):
            _normalise_node(document, node, ("nodes", name), notices)
    return notices


def _normalise_node(
    document: Document, node: dict[str, Any], path: KeyPath, notices: list[str]
) -> None:
    _drop_none(node)
    for key in _EMPTIED_BY_NONE:
        if isinstance(node.get(key), dict):
            _drop_none(node[key])
        if key in node and node[key] in (None, {}, "none", "None"):
            del node[key]
    _rename_param_path(document, node, path, notices)
    if node.get("parameters") is True:
        node["parameters_in"] = node.pop("parameters")
    for key in _TOPIC_KEYS:
        for topic in _mapping(node.get(key)):
            _normalise_type(document, node[key], (*path, key, topic), notices)


def _drop_none(mapping: dict[str, Any]) -> None:
    if "none" in mapping and mapping["none"] is None:
        del mapping["none"]


def _rename_param_path(
    document: Document, node: dict[str, Any], path: KeyPath, notices: list[str]
) -> None:
    if "param_path" not in node:
        return
    here, there = (*path, "param_path"), (*path, "param_file")
    if "param_file" in node:
        raise MapfileError(document.problem(here, "only param_file", "param_path beside it"))
    node["param_file"] = node.pop("param_path")
    document.lines[there] = document.line(here)
    notices.append(_notice(document, here, "param_path is read as param_file"))


def _normalise_type(
    document: Document, mapping: dict[str, Any], path: KeyPath, notices: list[str]
) -> None:
    written = mapping.get(path[-1])
    if not isinstance(written, str):
        return
    mapping[path[-1]] = canonical_type(written)
    if mapping[path[-1]] != written:
        notices.append(_notice(document, path, f"{written} is read as {mapping[path[-1]]}"))


def _notice(document: Document, path: KeyPath, text: str) -> str:
    return f"{document.file}:{document.line(path)}: {dotted(path)}: {text}"


def _mapping(value: Any) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}
