# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Definitions read by us and by rosidl: converted to IDL, parsed, described."""

from __future__ import annotations

import contextlib
import io
import keyword
from pathlib import Path
from typing import Any

import rosidl_generator_type_description as description
from rosidl_adapter.action import convert_action_to_idl
from rosidl_adapter.msg import convert_msg_to_idl
from rosidl_adapter.srv import convert_srv_to_idl
from rosidl_parser.definition import Action, Message, NamedType, NamespacedType, Service
from rosidl_parser.parser import parse_idl_string

from rmw_manycore_py.errors import DefinitionError
from rmw_manycore_py.interfaces.definition import read_definition
from support.comparisons.comparing import DisagreementError, run
from support.generated.definitions import PACKAGE, Made, made

CONVERT = {"msg": convert_msg_to_idl, "srv": convert_srv_to_idl, "action": convert_action_to_idl}
# Keywords of C and C++ among the generated names, also those of mutations.
C_WORDS = {
    *("bool", "char", "class", "const", "default", "double", "enum", "false", "float", "int"),
    *("long", "short", "struct", "true", "typedef", "unsigned"),
}


def ours(file: Path) -> tuple[set[str] | None, str]:
    """Return the references that we find, None if we refuse the file, and our error."""
    try:
        definition = read_definition(file, PACKAGE)
    except DefinitionError as error:
        lines = str(error).split("\n")
        if len(lines) != len(error.problems) or not all(line.isprintable() for line in lines):
            raise DisagreementError(f"not one line per problem: {error}") from error
        return None, str(error)
    lines = file.read_text().split("\n")
    for name, line in definition.references.items():
        if line and name.split("/")[-1] not in lines[line - 1] and "Alias" not in lines[line - 1]:
            raise DisagreementError(f"{name} is not in line {line}")
    return {name for name, line in definition.references.items() if line}, ""


def rosidls(file: Path, input_: Made) -> tuple[set[str] | None, str]:
    """Return the references that rosidl finds, None if no code could be generated, and why."""
    try:
        messages = _messages(_idl(file))
    except BaseException as error:  # templates end the process
        return None, f"rosidl: {type(error).__name__}: {error}"
    structures = [message.structure for message in messages]
    found = ["/".join(structure.namespaced_type.namespaced_name()) for structure in structures]
    if sorted(found) != sorted(input_.structures):
        return None, f"structures {found}"
    references = set()
    for structure in structures:
        names = [member.name for member in structure.members]
        wrong = [name for name in names if keyword.iskeyword(name) or name in C_WORDS]
        if wrong or len(set(names)) < len(names):
            return None, f"members {names}"
        for member in structure.members:
            type_ = getattr(member.type, "value_type", member.type)
            if isinstance(type_, NamespacedType):
                references.add("/".join(type_.namespaced_name()))
            if isinstance(type_, NamedType):
                return None, f"named type {type_.name}"
    strange = [name for name in references if name.count("/") != 2]
    return (None, f"references {strange}") if strange else (references, "")


def _idl(file: Path) -> str:
    if file.suffix == ".idl":
        return file.read_text(encoding="utf-8")
    package, output = file.parents[1], file.parents[2] / "idl"
    with contextlib.redirect_stderr(io.StringIO()):
        CONVERT[file.suffix[1:]](package, PACKAGE, file.relative_to(package), output)
    return (output / file.with_suffix(".idl").name).read_text(encoding="utf-8")


def _messages(idl: str) -> list[Any]:
    described: dict[str, Any] = {}
    messages = []
    for element in parse_idl_string(idl).elements:
        if isinstance(element, Message):
            description.add_msg(element, described)
            messages.append(element)
        elif isinstance(element, Service):
            description.add_srv(element, described)
            messages += [element.request_message, element.response_message]
        elif isinstance(element, Action):
            description.add_action(element, described)
            messages += [element.goal, element.result, element.feedback]
    for one in described.values():
        description.serialize_individual_type_description(one.namespaced_type, one.members)
    return messages


def compare(directory: Path, number: int) -> str:
    input_ = made(number)
    file = directory / PACKAGE / input_.kind / f"Thing.{input_.suffix}"
    file.parent.mkdir(parents=True, exist_ok=True)
    (directory / "idl").mkdir(exist_ok=True)
    file.write_bytes(input_.content)
    (found, problem), (real, reason) = ours(file), rosidls(file, input_)
    file.unlink()
    if found != real:
        raise DisagreementError(f"{found} {problem}, rosidl {real} {reason}\n{input_.content!r}")
    return "refused" if found is None else "accepted"


if __name__ == "__main__":
    run(compare)
