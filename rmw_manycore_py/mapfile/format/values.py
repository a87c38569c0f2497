# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Value types of a mapfile; each error names what was expected."""

from __future__ import annotations

import re
import shlex
from typing import Annotated, Any

from pydantic import BeforeValidator, StringConstraints, WithJsonSchema
from pydantic_core import PydanticCustomError

_UNITS = {"": 1, "B": 1, "KB": 10**3, "MB": 10**6, "KIB": 2**10, "MIB": 2**20, "GIB": 2**30}
_SIZE = re.compile(r"(\d{1,18})\s*([KMG]?I?B?)", re.IGNORECASE)
_SCALARS = (bool, int, float, str)


def refusal(text: str, **found: Any) -> PydanticCustomError:
    """Return a pydantic error that names what was expected."""
    return PydanticCustomError("expected", "{expected}", {"expected": text, **found})


def _size(value: Any) -> int:
    if isinstance(value, int) and not isinstance(value, bool) and value > 0:
        return value
    match = _SIZE.fullmatch(value.strip()) if isinstance(value, str) else None
    unit = _UNITS.get(match[2].upper()) if match else None
    if match is None or unit is None or int(match[1]) == 0:
        raise refusal("a positive number of bytes, or one with a unit such as 64KiB or 4MiB")
    return int(match[1]) * unit


def _environment_value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if not isinstance(value, (str, int, float)):
        raise refusal("a string or a number", found=value)
    return str(value)


def _arguments(value: Any) -> tuple[str, ...]:
    if isinstance(value, str):
        try:
            return tuple(shlex.split(value))
        except ValueError as error:
            raise refusal("words as typed in a shell, each quotation closed") from error
    if isinstance(value, (list, tuple)):
        return tuple(_environment_value(item) for item in value)
    raise refusal("a list of strings, or one string as typed in a shell")


def _command(value: Any) -> tuple[str, ...]:
    words = _arguments(value)
    if not words or not words[0]:
        raise refusal("a program and its arguments")
    return words


def _one_or_more(value: Any) -> tuple[str, ...]:
    names = (value,) if isinstance(value, str) else value
    if not isinstance(names, (list, tuple)) or not all(isinstance(n, str) and n for n in names):
        raise refusal("a file name or a list of file names")
    return tuple(names)


def _is_array(value: Any) -> bool:
    """Return whether a value is a ROS array: scalars of one kind; integers among floats count."""
    if not isinstance(value, (list, tuple)) or not value:
        return False
    kinds = {type(item) for item in value}
    return kinds <= set(_SCALARS) and (len(kinds) == 1 or kinds == {int, float})


def _host_cpus(value: Any) -> tuple[int, ...]:
    if value == "none":
        return ()
    cpus = value if isinstance(value, list) else [value]
    if not cpus or not all(type(cpu) is int and cpu >= 0 for cpu in cpus):
        raise refusal("a CPU of the host, a list of them, or none for all")
    return tuple(sorted(set(cpus)))


def _respawn(value: Any) -> Any:
    """Read true as an empty mapping, and false as no restarts, overriding the launch file."""
    if isinstance(value, bool):
        return {} if value else {"max_retries": 0}
    if not isinstance(value, dict):
        raise refusal("true, false or a mapping")
    return value


def flatten_parameters(value: Any, prefix: str = "") -> dict[str, Any]:
    """Return nested parameters by dotted name."""
    if not isinstance(value, dict):
        raise refusal("a mapping from parameter names to values")
    flat: dict[str, Any] = {}
    for name, item in value.items():
        if not isinstance(name, str):
            raise refusal("parameter names, in quotes where YAML reads something else", found=name)
        if isinstance(item, dict):
            flat |= flatten_parameters(item, f"{prefix}{name}.")
        elif isinstance(item, _SCALARS):
            flat[f"{prefix}{name}"] = item
        elif _is_array(item):
            has_floats = any(isinstance(part, float) for part in item)
            flat[f"{prefix}{name}"] = [float(p) for p in item] if has_floats else list(item)
        else:
            expected = "a bool, a number, a string or a non-empty list of one of these"
            raise refusal(expected, found=item, name=f"{prefix}{name}")
    return flat


_SCALAR_SCHEMA: dict[str, Any] = {"type": ["string", "number", "boolean"]}
Size = Annotated[
    int,
    BeforeValidator(_size),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "integer", "minimum": 1},
                {"type": "string", "pattern": r"^\d+\s*([KkMmGg]?[Ii]?[Bb]?)$"},
            ]
        }
    ),
]
_CPU_SCHEMA: dict[str, Any] = {"type": "integer", "minimum": 0}
HostCpus = Annotated[
    tuple[int, ...],
    BeforeValidator(_host_cpus),
    WithJsonSchema(
        {
            "anyOf": [
                _CPU_SCHEMA,
                {"type": "array", "items": _CPU_SCHEMA, "minItems": 1},
                {"const": "none"},
            ]
        }
    ),
]
EnvironmentValue = Annotated[
    str,
    BeforeValidator(_environment_value),
    WithJsonSchema(_SCALAR_SCHEMA),
]
_WORDS_SCHEMA = WithJsonSchema(
    {"anyOf": [{"type": "string"}, {"type": "array", "items": _SCALAR_SCHEMA}]}
)
Arguments = Annotated[tuple[str, ...], BeforeValidator(_arguments), _WORDS_SCHEMA]
Command = Annotated[tuple[str, ...], BeforeValidator(_command), _WORDS_SCHEMA]
OneOrMore = Annotated[
    tuple[str, ...],
    BeforeValidator(_one_or_more),
    WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}]}),
]
Parameters = Annotated[
    dict[str, Any], BeforeValidator(flatten_parameters), WithJsonSchema({"type": "object"})
]
# Precedes a section: also accepts true and false.
OrBool = BeforeValidator(_respawn)
MessageType = Annotated[str, StringConstraints(pattern=r"^[A-Za-z]\w*/msg/[A-Z][A-Za-z0-9]*$")]
InterfaceType = Annotated[
    str, StringConstraints(pattern=r"^[A-Za-z]\w*/(msg|srv)/[A-Z][A-Za-z0-9]*$")
]
ServiceType = Annotated[str, StringConstraints(pattern=r"^[A-Za-z]\w*/srv/[A-Z][A-Za-z0-9]*$")]
ActionType = Annotated[str, StringConstraints(pattern=r"^[A-Za-z]\w*/action/[A-Z][A-Za-z0-9]*$")]
