# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Client of the parameter services of a node."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from rmw_manycore_py.cli.common.tool_node import ANSWER_TIMEOUT_S, result_of
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.errors.suggestions import did_you_mean
from rmw_manycore_py.ros.parameter_files import applies, read_file, values_for

# Index = value in rcl_interfaces/msg/ParameterType: the name, and ros2cli's label of a value.
TYPES = (
    ("not set", "Parameter not set."),
    ("boolean", "Boolean value is:"),
    ("integer", "Integer value is:"),
    ("double", "Double value is:"),
    ("string", "String value is:"),
    ("byte array", "Byte values are:"),
    ("boolean array", "Boolean values are:"),
    ("integer array", "Integer values are:"),
    ("double array", "Double values are:"),
    ("string array", "String values are:"),
)


class Parameters:
    """Client of the parameters of one node."""

    def __init__(self, node: Any, name: str) -> None:
        from rclpy.parameter_client import AsyncParameterClient

        self._node, self.node_name = node, name
        self._client = AsyncParameterClient(node, name)
        if not self._client.wait_for_services(timeout_sec=ANSWER_TIMEOUT_S):
            raise ManycoreError(f"node '{name}' has no parameter services")

    def names(self, prefixes: Sequence[str] = ()) -> list[str]:
        """Return the names of all parameters, or of those below the prefixes."""
        answer = self._answer(lambda: self._client.list_parameters(list(prefixes) or None))
        return sorted(answer.result.names)

    def values(self, names: Sequence[str]) -> list[tuple[int, Any]]:
        """Return type and value of each parameter; raise ManycoreError for undeclared ones."""
        from rclpy.parameter import parameter_value_to_python

        answer = self._answer(lambda: self._client.get_parameters(list(names)))
        if len(answer.values) != len(names):
            raise self._not_set(names)
        return [(value.type, parameter_value_to_python(value)) for value in answer.values]

    def descriptors(self, names: Sequence[str]) -> list[Any]:
        """Return the rcl_interfaces ParameterDescriptor of each parameter."""
        answer = self._answer(lambda: self._client.describe_parameters(list(names)))
        if len(answer.descriptors) != len(names):
            raise self._not_set(names)
        return list(answer.descriptors)

    def set(self, parameters: Sequence[Any]) -> Iterator[tuple[str, Any]]:
        """Set rcl_interfaces Parameters; yield each name with its SetParametersResult."""
        answer = self._answer(lambda: self._client.set_parameters(list(parameters)))
        for parameter, result in zip(parameters, answer.results, strict=True):
            yield parameter.name, result

    def meant_by(self, name: str) -> str:
        """Return "; did you mean 'x'?" for a name that is not declared."""
        known = self.names()
        return "" if name in known else did_you_mean(name, known)

    def _not_set(self, names: Iterable[str]) -> ManycoreError:
        known = self.names()
        missing = [name for name in names if name not in known]
        meant = self.meant_by(missing[0]) if missing else ""
        return ManycoreError(f"Parameter not set: {self.node_name} has no {_list(missing)}{meant}")

    def _answer(self, ask: Callable[[], Any]) -> Any:
        return result_of(self._node, ask, f"parameters of {self.node_name}")


def parameter_of(name: str, text: str | None) -> Any:
    """Return an rcl_interfaces Parameter with a value given in YAML; None unsets it."""
    from rcl_interfaces.msg import Parameter, ParameterValue
    from rclpy.parameter import get_parameter_value

    value = ParameterValue() if text is None else get_parameter_value(text)
    return Parameter(name=name, value=value)


def parameters_of_file(path: str, node: str, *, wildcard: bool = True) -> list[Any]:
    """Return the rcl_interfaces Parameters for a node in a parameter file.

    With `wildcard`, include those of sections for several nodes.
    """
    from rclpy.parameter import Parameter

    sections = read_file(Path(path))
    fitting = [
        (name, values)
        for name, values in sections
        if applies(name, node) and (wildcard or "*" not in name)
    ]
    if not fitting:
        known = _list(name for name, _ in sections) or "none"
        reason = f"{path}: no parameters for {node}: there are some for {known}"
        raise ManycoreError(reason, EXIT_BAD_INPUT)
    values = values_for(fitting, node)
    return [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]


def nested(values: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Return parameters nested as in a parameter file: a.b becomes b below a.

    It stays a.b if a is a parameter, too, which then has to come first.
    """
    root: dict[str, Any] = {}
    for name, value in values:
        parts = name.split(".")
        place = root
        while len(parts) > 1 and isinstance(group := place.setdefault(parts[0], {}), dict):
            place = group
            del parts[0]
        place[".".join(parts)] = value
    return root


def _list(names: Iterable[str]) -> str:
    return ", ".join(names)
