# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameters in launch files: values, substitutions, and parameter files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.format.document import parse_yaml, read_text
from rmw_manycore_py.mapfile.launch_file import text
from rmw_manycore_py.mapfile.launch_file.context import (
    LaunchContext,
    LaunchFileError,
    NotInstalledError,
)
from rmw_manycore_py.mapfile.launch_file.launched import ExpandedFile, ForAllNodes, ParameterSource
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

    def evaluate(self, context: LaunchContext) -> ParameterSource:
        """Return the file, with its substitutions performed if it may have some."""
        path = Path(os.path.expanduser(perform(context, self.param_file)))
        if not os.path.isfile(path):
            if context.is_missing(path) or is_true(context, self.allow_substs):
                raise NotInstalledError("an existing parameter file", str(path))
            context.notice(0, f"no such parameter file, so it is left out: {path}")
            return {}
        if not is_true(context, self.allow_substs):
            return path
        return ExpandedFile(path, perform(context, text.parse(read_text(path))))


def evaluate_all(context: LaunchContext, sources: Any) -> tuple[ParameterSource, ...]:
    """Return the parameters of a node in the order in which launch gives them to rcl."""
    return tuple(_evaluate(context, source) for source in sources or ())


def _evaluate(context: LaunchContext, source: Any) -> ParameterSource:
    if isinstance(source, Mapping):
        return dict(_flat(context, source, ""))
    if isinstance(source, Parameter):
        return ForAllNodes({perform(context, source.name): source.value.evaluate(context)})
    if isinstance(source, ParameterFile):
        return source.evaluate(context)
    return ParameterFile(source).evaluate(context)


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
    return value if isinstance(value, (bool, int, float, str, list)) else words
