# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A definition (`.msg`, `.srv`, `.action` or `.idl`) and the types it refers to."""

from __future__ import annotations

import contextlib
import io
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rosidl_adapter.msg import string_to_idl_string_literal
from rosidl_adapter.parser import is_valid_message_name, parse_message_string

from rmw_manycore_py.errors import DefinitionError, Problem
from rmw_manycore_py.interfaces.field_names import check_field_name

KINDS = ("msg", "srv", "action")
SEPARATOR = "---"
# Names of the parts of a definition, in order.
_PARTS = {
    "msg": ("",),
    "srv": ("_Request", "_Response"),
    "action": ("_Goal", "_Result", "_Feedback"),
}
# Types added by the generators to every service and action.
_IMPLIED = {
    "msg": (),
    "srv": ("service_msgs/msg/ServiceEventInfo", "builtin_interfaces/msg/Time"),
    "action": (
        *("service_msgs/msg/ServiceEventInfo", "builtin_interfaces/msg/Time"),
        *("unique_identifier_msgs/msg/UUID", "action_msgs/msg/GoalInfo"),
        *("action_msgs/msg/GoalStatusArray", "action_msgs/srv/CancelGoal"),
    ),
}
# A string that rosidl's grammar of IDL reads.
_LITERAL = re.compile(r'"([^"\\\n]|\\.)*"')
_REPLACED = {"time": "builtin_interfaces/Time", "duration": "builtin_interfaces/Duration"}


@dataclass(frozen=True)
class Definition:
    """A definition that is valid in itself."""

    name: str  # package/msg/Name
    file: Path
    references: dict[str, int]  # types by first line; 0: implied

    @property
    def kind(self) -> str:
        """Return "msg", "srv" or "action"."""
        return self.name.split("/")[1]


def read_definition(file: Path, package: str) -> Definition:
    """Read a definition; its directory name is its kind.

    :raises DefinitionError: with file and line.
    """
    kind, name = file.parent.name, file.stem
    if file.suffix not in (f".{kind}", ".idl"):
        raise _error(file, 0, name, f"a .{kind} or .idl file in a directory '{kind}'", file.name)
    if not is_valid_message_name(name) or "_" in name:
        raise _error(file, 0, name, "a name such as PoseStamped", f"'{name}'")
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise _error(file, 0, name, "a text file in UTF-8", str(error)) from error
    full_name = f"{package}/{kind}/{name}"
    if file.suffix == ".idl":
        from rmw_manycore_py.interfaces.idl import read_idl  # late: imports rosidl's parser of IDL

        found = read_idl(file, [full_name + part for part in _PARTS[kind]], text)
    else:
        found = _references(file, full_name, text)
    return Definition(full_name, file, {**dict.fromkeys(_IMPLIED[kind], 0), **found})


def _references(file: Path, full_name: str, text: str) -> dict[str, int]:
    package, kind, name = full_name.split("/")
    lines = text.splitlines()
    separators = [number for number, line in enumerate(lines) if line == SEPARATOR]
    parts = _PARTS[kind]
    if len(separators) != len(parts) - 1:
        line = separators[len(parts) - 1] + 1 if len(separators) >= len(parts) else len(lines)
        expected = f"{len(parts)} parts, separated by lines of {SEPARATOR}"
        raise _error(file, line, name, expected, str(len(separators) + 1))
    found: dict[str, int] = {}
    starts = [0, *(number + 1 for number in separators)]
    for part, start, end in zip(parts, starts, [*separators, len(lines)], strict=True):
        for field, line in _fields(file, package, name + part, lines[start:end], start):
            type_ = field.type
            if type_.is_primitive_type():
                if type_.type in _REPLACED:
                    raise _error(file, line, field.name, _REPLACED[type_.type], type_.type)
                continue
            found.setdefault(f"{type_.pkg_name}/msg/{type_.type}", line)
    return found


def _fields(
    file: Path, package: str, name: str, lines: list[str], start: int
) -> Iterator[tuple[Any, int]]:
    """Yield the fields of one part of a definition with their lines, counted from 1."""
    message = _parsed(file, package, name, lines, start)
    names = [line.partition("#")[0].split()[1:2] for line in lines]
    for field in message.fields:
        line = start + 1 + names.index([field.name])
        check_field_name(file, line, field.name)
        yield field, line
    for element in (message, *message.fields, *message.constants):
        for text in _texts(element):
            if not _is_literal(text):
                line = next((n for n, one in enumerate(lines, start + 1) if text in one), 0)
                expected = "a text whose backslashes and quotes an IDL string can have"
                raise _error(file, line, "", expected, f"'{text}'")


def _texts(element: Any) -> Iterator[str]:
    """Yield the texts that rosidl copies into the .idl file as string literals."""
    yield from element.annotations.get("comment", ())
    yield element.annotations.get("unit", "")
    for name in ("value", "default_value"):
        value = getattr(element, name, "")
        if isinstance(value, str):
            yield value


def _is_literal(text: str) -> bool:
    try:
        return bool(_LITERAL.fullmatch(string_to_idl_string_literal(text)))
    except UnicodeDecodeError:
        return False


def _parsed(file: Path, package: str, name: str, lines: list[str], start: int) -> Any:
    """Parse a part with rosidl; on failure, find the line by parsing prefixes."""
    error = None
    for end in (len(lines), *range(1, len(lines) + 1)):
        try:
            with contextlib.redirect_stderr(io.StringIO()):
                message = parse_message_string(package, name, "\n".join(lines[:end]))
        except Exception as wrong:  # rosidl raises many types
            if error is not None:  # the first prefix that fails
                text = lines[end - 1].strip()
                found = f"'{text}'" if str(wrong) in text else f"'{text}': {wrong}"
                raise _error(file, start + end, "", "a field or a constant", found) from wrong
            error = wrong
        else:
            if error is None:
                return message
    raise _error(file, start, "", "fields and constants", str(error)) from error


def _error(file: Path, line: int, key: str, expected: str, found: str) -> DefinitionError:
    return DefinitionError(Problem(file, line, key, expected, found))
