# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""ROS 2 parameter files: sections that apply to a node."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic_core import PydanticCustomError

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.format.document import Document, dotted, read_yaml
from rmw_manycore_py.mapfile.format.parameter_sections import sections_of
from rmw_manycore_py.mapfile.format.validation import describe
from rmw_manycore_py.mapfile.format.values import flatten_parameters


def parameters_in(file: Path, full_name: str) -> dict[str, Any]:
    """Return the parameters of a node in a parameter file, by dotted name."""
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
