# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A definition (`.msg`, `.srv`, `.action` or `.idl`) and the types it refers to."""

from __future__ import annotations

import contextlib
import io
import keyword
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rosidl_adapter.parser import is_valid_message_name, parse_message_string

from rmw_manycore_py.errors import DefinitionError, Problem

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
# Keywords that cannot be field names in generated C and C++.
_C_WORDS = frozenset(
    {
        *("alignas", "alignof", "asm", "auto", "bool", "break", "case", "catch", "char", "class"),
        *("const", "constexpr", "const_cast", "continue", "decltype", "default", "delete", "do"),
        *("double", "dynamic_cast", "else", "enum", "explicit", "export", "extern", "false"),
        *("float", "for", "friend", "goto", "if", "inline", "int", "long", "mutable", "namespace"),
        *("new", "noexcept", "nullptr", "operator", "private", "protected", "public", "register"),
        *("reinterpret_cast", "restrict", "return", "short", "signed", "sizeof", "static"),
        *("static_assert", "static_cast", "struct", "switch", "template", "this", "thread_local"),
        *("throw", "true", "try", "typedef", "typeid", "typename", "union", "unsigned", "using"),
        *("virtual", "void", "volatile", "wchar_t", "while"),
    }
)
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
    read = _idl_references if file.suffix == ".idl" else _references
    references = {**dict.fromkeys(_IMPLIED[kind], 0), **read(file, full_name, text)}
    return Definition(full_name, file, references)


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
    for field in message.fields:
        pattern = re.compile(rf"\s*\S+\s+{field.name}\b")
        line = next(n for n, text in enumerate(lines, start + 1) if pattern.match(text))
        if keyword.iskeyword(field.name) or field.name in _C_WORDS:
            expected = "a name that is no keyword of Python, C or C++"
            raise _error(file, line, field.name, expected, f"'{field.name}'")
        yield field, line


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


def _idl_references(file: Path, full_name: str, text: str) -> dict[str, int]:
    from rosidl_parser.definition import Action, Message, NamespacedType, Service
    from rosidl_parser.parser import parse_idl_string

    try:
        content = parse_idl_string(text)
    except Exception as error:  # lark errors have a line
        line = max(getattr(error, "line", 0) or 0, 0)
        raise _error(file, line, "", "IDL 4.2", str(error).splitlines()[0]) from error
    messages = list(content.get_elements_of_type(Message))
    names = [message.structure.namespaced_type for message in messages]
    for service in content.get_elements_of_type(Service):
        names.append(service.namespaced_type)
        messages += [service.request_message, service.response_message]
    for action in content.get_elements_of_type(Action):
        names.append(action.namespaced_type)
        messages += [action.goal, action.result, action.feedback]
    defined = ["/".join(name.namespaced_name()) for name in names]
    if full_name not in defined:
        raise _error(file, 0, "", full_name, ", ".join(defined) or "no type")
    members = [member.type for message in messages for member in message.structure.members]
    types = [getattr(type_, "value_type", type_) for type_ in members]
    return {
        "/".join(type_.namespaced_name()): _line_of(text, "::".join(type_.namespaced_name()))
        for type_ in types
        if isinstance(type_, NamespacedType)
    }


def _line_of(text: str, name: str) -> int:
    """Return the first line that names a type; 0 if there is none."""
    return text[: text.find(name)].count("\n") + 1 if name in text else 0


def _error(file: Path, line: int, key: str, expected: str, found: str) -> DefinitionError:
    return DefinitionError(Problem(file, line, key, expected, found))
