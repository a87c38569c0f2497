# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameters in launch files: values, substitutions, and parameter files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import yaml

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.format.document import parse_yaml, read_yaml
from rmw_manycore_py.mapfile.format.parameter_sections import sections_of
from rmw_manycore_py.mapfile.format.validation import describe
from rmw_manycore_py.mapfile.launch_file import text
from rmw_manycore_py.mapfile.launch_file.context import (
    LaunchContext,
    LaunchFileError,
    NotInstalledError,
)
from rmw_manycore_py.mapfile.launch_file.launched import ParameterSource
from rmw_manycore_py.mapfile.launch_file.substitutions import Substitution, is_true, perform

_SCALARS = (bool, int, float, str)
_TYPES = {bool: "bool", int: "int", float: "float", str: "str"}


class ParameterValue:
    """A value with an explicit type, so that the text of a substitution is not guessed."""

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value, self.value_type = value, value_type

    def evaluate(self, context: LaunchContext) -> Any:
        """Return the value converted to its type."""
        if self.value_type is None:
            return _value(context, self.value)
        if self.value_type is str:
            return perform(context, self.value)
        value = _value(context, self.value)
        if self.value_type is float and type(value) is int:
            return float(value)
        if self.value_type in _TYPES and type(value) is not self.value_type:
            raise LaunchFileError(f"a parameter of type {_TYPES[self.value_type]}", repr(value))
        return value


class Parameter:
    """A named parameter."""

    def __init__(self, name: Any, value: Any, *, value_type: Any = None) -> None:
        self.name, self.value = name, ParameterValue(value, value_type=value_type)


class ParameterFile:
    """A parameter file, optionally with substitutions."""

    def __init__(self, param_file: Any, *, allow_substs: Any = False) -> None:
        self.param_file, self.allow_substs = param_file, allow_substs

    def evaluate(self, context: LaunchContext, node: str) -> ParameterSource:
        """Return the file or, if it has substitutions, its parameters for `node`."""
        path = Path(os.path.expanduser(perform(context, self.param_file)))
        if not os.path.isfile(path):
            if context.is_missing(path) or is_true(context, self.allow_substs):
                raise NotInstalledError("an existing parameter file", str(path))
            context.notice(0, f"no such parameter file, so it is left out: {path}")
            return {}
        if not is_true(context, self.allow_substs):
            return path
        return _expanded(context, path, node)


def evaluate_all(context: LaunchContext, sources: Any, node: str) -> tuple[ParameterSource, ...]:
    """Return the parameters of a node in order; later ones take precedence."""
    return tuple(_evaluate(context, source, node) for source in sources or ())


def _evaluate(context: LaunchContext, source: Any, node: str) -> ParameterSource:
    if isinstance(source, Mapping):
        return dict(_flat(context, source, ""))
    if isinstance(source, Parameter):
        return {perform(context, source.name): source.value.evaluate(context)}
    if isinstance(source, ParameterFile):
        return source.evaluate(context, node)
    return ParameterFile(source).evaluate(context, node)


def _flat(
    context: LaunchContext, source: Mapping[Any, Any], prefix: str
) -> Iterable[tuple[str, Any]]:
    for key, value in source.items():
        name = prefix + perform(context, key)
        if isinstance(value, Mapping):
            yield from _flat(context, value, f"{name}.")
        else:
            yield name, _value(context, value)


def _value(context: LaunchContext, value: Any) -> Any:
    if isinstance(value, ParameterValue):
        return value.evaluate(context)
    if isinstance(value, (str, bool, int, float)):
        return value
    if isinstance(value, Substitution):
        return _typed(perform(context, value))
    if isinstance(value, (list, tuple)):
        if any(isinstance(part, Substitution) for part in value):
            return _typed(perform(context, value))
        return _of_one_type([_value(context, part) for part in value])
    raise LaunchFileError("a parameter value", repr(value))


def _of_one_type(items: list[Any]) -> list[Any]:
    """Convert an array of mixed types as ROS 2 launch does: to floats, else to strings."""
    kinds = {type(item) for item in items}
    if len(kinds) > 1:
        convert = float if kinds == {int, float} else str
        return [convert(item) for item in items]
    return items


def _typed(words: str) -> Any:
    """Parse a text as YAML, as ROS 2 launch does to type substitutions."""
    try:
        value = parse_yaml(words, Path()).data
    except MapfileError:
        return words
    if isinstance(value, list) and not all(isinstance(part, _SCALARS) for part in value):
        raise LaunchFileError("a list of bools, numbers or strings", repr(words))
    if isinstance(value, float) and not isinstance(yaml.safe_load(words), float):
        return words  # 1e-9 is a number for rcl, but not in YAML 1.1
    return value if isinstance(value, (bool, int, float, str, list)) else words


def _expanded(context: LaunchContext, path: Path, node: str) -> dict[str, Any]:
    document = read_yaml(path)
    data = document.data or {}
    if not isinstance(data, Mapping):
        expected = "node names, each with 'ros__parameters'"
        raise MapfileError(document.problem((), expected, describe(data)))
    chosen: dict[str, Any] = {}
    for section in sections_of(data, node):
        chosen |= dict(_flat(context, _substitute(section), ""))
    return chosen


def _substitute(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _substitute(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_substitute(item) for item in value]
    return text.parse(value) if isinstance(value, str) and "$(" in value else value
