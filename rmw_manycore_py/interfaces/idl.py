# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads a definition in IDL with rosidl's parser; finds the lines of its errors."""

from __future__ import annotations

import traceback
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from rosidl_generator_type_description import serialize_individual_type_description
from rosidl_parser.definition import (
    Action,
    Member,
    Message,
    NamedType,
    NamespacedType,
    Service,
    Structure,
)
from rosidl_parser.parser import (
    extract_content_from_ast,
    get_ast_from_idl_string,
    get_module_identifier_values,
)

from rmw_manycore_py.errors import DefinitionError, Problem, what_is_wrong
from rmw_manycore_py.interfaces.field_names import check_field_name

_SUPPORTED = (
    "IDL that rosidl supports: no enum as a type, no typedef of a typedef, no array of arrays, no "
    "expression as a value"
)
_TYPE = "a type such as geometry_msgs::msg::Pose"


def read_idl(file: Path, structures: Sequence[str], text: str) -> dict[str, int]:
    """Return the types that a definition refers to, with their first lines.

    :param structures: package/kind/Name of each structure that the file has to define.
    :raises DefinitionError: with file and line.
    """
    return _IdlFile(file, text).references(structures)


class _IdlFile:
    def __init__(self, file: Path, text: str) -> None:
        self._file = file
        self._lines = text.split("\n")
        try:
            self._tree: Any = get_ast_from_idl_string(text)
        except Exception as error:  # those of lark have a line; at the end of the file it is -1
            line = getattr(error, "line", 0)
            line = line if line >= 0 else text.rstrip().count("\n") + 1
            reason = what_is_wrong(error).splitlines()[0].removesuffix(" Expected one of: ")
            raise self._error(line, "", "IDL 4.2", reason) from error

    def references(self, structures: Sequence[str]) -> dict[str, int]:
        self._check_structures(structures)
        found: dict[str, int] = {}
        for message in self._messages():
            for member, line in self._members(message):
                type_ = getattr(member.type, "value_type", member.type)
                if isinstance(type_, NamedType):
                    raise self._error(line, member.name, _TYPE, f"'{type_.name}'")
                if isinstance(type_, NamespacedType):
                    name = type_.namespaced_name()
                    if len(name) != 3:
                        raise self._error(line, member.name, _TYPE, f"'{'::'.join(name)}'")
                    found.setdefault("/".join(name), line)
        return found

    def _check_structures(self, expected: Sequence[str]) -> None:
        nodes = list(self._tree.find_data("struct_def"))
        names = {
            "/".join([*get_module_identifier_values(self._tree, node), _identifier(node)]): node
            for node in nodes
        }
        if len(nodes) != len(expected) or set(names) != set(expected):
            strange = [_line(node) for name, node in names.items() if name not in expected]
            found = ", ".join(sorted(names)) or "no struct"
            wanted = f"{' and '.join(expected)}, and no other struct"
            raise self._error(min(strange, default=0), "", wanted, found)

    def _messages(self) -> Iterator[Any]:
        try:
            content = extract_content_from_ast(self._tree)
        except Exception as error:  # rosidl asserts what it does not support
            raise self._refused(self._line_of(error), "", error) from error
        yield from content.get_elements_of_type(Message)
        for service in content.get_elements_of_type(Service):
            yield from (service.request_message, service.response_message)
        for action in content.get_elements_of_type(Action):
            yield from (action.goal, action.result, action.feedback)

    def _members(self, message: Any) -> Iterator[tuple[Any, int]]:
        """Yield the members of a structure that can be generated, with their lines."""
        name = message.structure.namespaced_type
        names = set()
        for member in message.structure.members:
            line = self._line_of_member(name.name, member.name)
            check_field_name(self._file, line, member.name)
            if member.name in names:
                raise self._error(line, member.name, "a name for each member", "it again")
            names.add(member.name)
            try:
                serialize_individual_type_description(name, [member])
            except Exception as error:  # rosidl parses more than it can describe
                raise self._refused(line, member.name, error) from error
            yield member, line

    def _line_of_member(self, structure: str, name: str) -> int:
        return max(
            _line(declarator)
            for node in self._tree.find_data("struct_def")
            if _identifier(node) == structure
            for declarator in node.find_data("declarator")
            if _identifier(declarator.children[0]) == name
        )

    def _line_of(self, error: Exception) -> int:
        """Return the line of the smallest part of the file that rosidl was processing."""
        for frame, _ in reversed(list(traceback.walk_tb(error.__traceback__))):
            values = list(frame.f_locals.values())
            names = [value.namespaced_type.name for value in values if isinstance(value, Structure)]
            members = [value.name for value in values if isinstance(value, Member)]
            if names and members:
                return self._line_of_member(names[0], members[0])
            nodes = [value for value in values if hasattr(value, "scan_values") and _line(value)]
            if nodes:
                return _line(min(nodes, key=lambda node: len(_tokens(node))))
        return 0

    def _refused(self, line: int, key: str, error: Exception) -> DefinitionError:
        text = f"'{self._lines[line - 1].strip()}'" if line else what_is_wrong(error)
        reason = str(error) if isinstance(error, AssertionError) else ""
        reason = reason.partition("Tree(")[0].strip(" [:")
        return self._error(line, key, _SUPPORTED, f"{text}: {reason}" if reason else text)

    def _error(self, line: int, key: str, expected: str, found: str) -> DefinitionError:
        return DefinitionError(Problem(self._file, line, key, expected, found))


def _tokens(node: Any) -> list[Any]:
    return list(node.scan_values(lambda value: hasattr(value, "line")))


def _line(node: Any) -> int:
    """Return the first line of a part of the file; 0 if it has only keywords."""
    return min((int(token.line) for token in _tokens(node)), default=0)


def _identifier(node: Any) -> str:
    return next(str(token) for token in node.children if getattr(token, "type", "") == "IDENTIFIER")
