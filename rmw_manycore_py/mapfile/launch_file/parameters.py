# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameters in launch files: values, substitutions, and parameter files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rmw_manycore_py.mapfile.format.document import read_text
from rmw_manycore_py.mapfile.launch_file import text, unavailable
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.launched import ExpandedFile, ForAllNodes, ParameterSource
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError, UnavailableError
from rmw_manycore_py.mapfile.launch_file.substitution import Substitution, perform
from rmw_manycore_py.mapfile.launch_file.typed_values import (
    SCALARS,
    boolean,
    from_yaml,
    is_substitution,
    kind_of,
    normalise,
    perform_typed,
)


class ParameterValue:
    """A value with an explicit type, so that the text of a substitution is not guessed."""

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value_type = value_type
        self._kind = kind_of(value_type)
        self.value = normalise(value, self._kind)

    def evaluate(self, context: LaunchContext) -> Any:
        """Return the value converted to its type."""
        return _usable(perform_typed(context, self.value, self._kind))


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
        has_substitutions = boolean(context, self.allow_substs)
        if os.path.isfile(path):
            if has_substitutions:
                return ExpandedFile(path, perform(context, text.parse(read_text(path))))
            return path
        if has_substitutions:
            raise _no_file(path)
        context.notice(0, f"no such parameter file, so it is left out: {path}")
        return {}


def evaluate_all(context: LaunchContext, sources: Any) -> tuple[ParameterSource, ...]:
    """Return the values and files of a list in its order."""
    return tuple(_evaluate(context, source) for source in sources or ())


def parameters_of(context: LaunchContext, own: Any) -> tuple[ParameterSource, ...]:
    """Return the parameters of a node in the order in which launch gives them to rcl.

    Those of `set_parameter` come first; unlike the node's own files, theirs have to exist.
    """
    settings = context.settings.parameters
    for source in settings:
        if isinstance(source, Path) and not os.path.isfile(source):
            raise _no_file(source)
    return (*settings, *evaluate_all(context, own))


def flat(context: LaunchContext, source: Mapping[Any, Any]) -> dict[str, Any]:
    """Return parameters by full name; an array is a tuple, except that of a ParameterValue."""
    return dict(_flat(context, source, ""))


def _value_of(context: LaunchContext, value: Any) -> Any:
    """Return the value of a parameter as launch_ros evaluates it."""
    if isinstance(value, ParameterValue):
        return value.evaluate(context)
    if isinstance(value, SCALARS):
        return _usable(value)
    if isinstance(value, Substitution):
        return _of_text(perform(context, value))
    if isinstance(value, Sequence) and not isinstance(value, bytes):
        return _array(context, value)
    raise LaunchFileError("a parameter value", repr(value))


def _evaluate(context: LaunchContext, source: Any) -> ParameterSource:
    if isinstance(source, Mapping):
        values = flat(context, source).items()
        return {name: list(value) if isinstance(value, tuple) else value for name, value in values}
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
            yield name, _value_of(context, value)


def _of_text(words: str) -> Any:
    """Return the value of a substitution's text, read as YAML."""
    value = from_yaml(words) if words else ""
    if isinstance(value, list):
        return _uniform(value)
    if not isinstance(value, SCALARS):
        expected = "a bool, number, text or list (else ParameterValue(..., value_type=str))"
        raise LaunchFileError(expected, repr(words))
    return value


def _array(context: LaunchContext, items: Sequence[Any]) -> Any:
    """Return an array; texts and substitutions alone are the parts of one text."""
    if is_substitution(list(items)):
        return _of_text(perform(context, items))
    types = {type(item) for item in items}
    if types and types <= {int, float}:
        return tuple(item if types == {int} else float(item) for item in items)
    return _uniform([_array_item(context, item) for item in items])


def _array_item(context: LaunchContext, item: Any) -> Any:
    if isinstance(item, SCALARS):
        return _usable(item)
    if isinstance(item, (Substitution, Sequence)):
        return from_yaml(perform(context, item))
    raise LaunchFileError("a parameter value", repr(item))


def _uniform(items: list[Any]) -> tuple[Any, ...]:
    kind = type(items[0]) if items else None
    if kind not in SCALARS or not all(isinstance(item, kind) for item in items):
        expected = "a list that is not empty, of bools, numbers or texts of one type"
        raise LaunchFileError(expected, repr(items))
    return tuple(items)


def _usable(value: Any) -> Any:
    """Return a value; raise UnavailableError if it depends on something missing here."""
    for item in value if isinstance(value, list) else (value,):
        if isinstance(item, str):
            unavailable.available(item)
    return value


def _no_file(path: Path) -> UnavailableError:
    return UnavailableError("an existing parameter file", str(path))
