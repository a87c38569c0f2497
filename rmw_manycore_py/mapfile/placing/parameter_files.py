# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""ROS 2 parameter files: which of their sections concern a node."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic_core import PydanticCustomError

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.format.document import Document, dotted, read_yaml
from rmw_manycore_py.mapfile.format.validation import describe
from rmw_manycore_py.mapfile.format.values import flatten_parameters


def sections_of(data: Any, full_name: str) -> list[Mapping[str, Any]]:
    """Return the sections for a node, those for many nodes first."""
    namespace, _, name = full_name.rpartition("/")
    found = []
    for key in ("/**", f"{namespace}/*", name if not namespace else None, full_name):
        section = data.get(key) if isinstance(data, Mapping) and key is not None else None
        if section is None and key == full_name and isinstance(data, Mapping):
            section = _nested(data, full_name)
        if isinstance(section, Mapping) and isinstance(section.get("ros__parameters"), Mapping):
            found.append(section["ros__parameters"])
    return found


def _nested(data: Mapping[str, Any], full_name: str) -> Any:
    """Follow a name that is written one namespace below the other."""
    section: Any = data
    for part in full_name.strip("/").split("/"):
        section = section.get(part, section.get(f"/{part}")) if isinstance(section, dict) else None
    return section


def parameters_in(file: Path, full_name: str) -> dict[str, Any]:
    """Return what a parameter file says for a node, under dotted names."""
    document = read_yaml(file)
    if not isinstance(document.data, dict) or not all(map(_is_section, document.data.values())):
        raise MapfileError(_not_a_parameter_file(document))
    found: dict[str, Any] = {}
    for section in sections_of(document.data, full_name):
        try:
            found |= flatten_parameters(section)
        except PydanticCustomError as error:
            raise MapfileError(_not_a_parameter(document, error)) from error
    return found


def _not_a_parameter(document: Document, error: PydanticCustomError) -> Problem:
    details = error.context or {}
    name = str(details.get("name", ""))
    lines = (line for path, line in document.lines.items() if dotted(path).endswith(f".{name}"))
    found = describe(details.get("found"))
    return Problem(document.file, next(lines, 1), name, str(details["expected"]), found)


def _is_section(value: Any) -> bool:
    if not isinstance(value, dict):
        return False
    return "ros__parameters" in value or all(map(_is_section, value.values()))


def _not_a_parameter_file(document: Document) -> Any:
    expected = "node names, each with 'ros__parameters'"
    keys = ", ".join(map(str, document.data)) if isinstance(document.data, dict) else "no mapping"
    return document.problem((), expected, keys)
