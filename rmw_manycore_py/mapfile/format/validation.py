# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Translates pydantic errors to mapfile problems: key, line, expected, found."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from rmw_manycore_py.errors import Problem, shorten
from rmw_manycore_py.errors.suggestions import closest
from rmw_manycore_py.mapfile.format.document import Document, KeyPath
from rmw_manycore_py.mapfile.format.model import (
    BridgeSection,
    HostSection,
    MapfileSections,
    NodeSection,
    OutsideSection,
    PlatformSection,
    QosSection,
    RespawnSection,
    RouteSection,
    SchedulingSection,
    TopicSection,
)

_EXPECTED = {
    "int_type": "an integer",
    "bool_type": "true or false",
    "string_type": "a string",
    "dict_type": "a mapping",
    "model_type": "a mapping",
    "string_too_short": "a non-empty string",
    "string_too_long": "at most {max_length} characters",
    "too_short": "at least one entry",
    "greater_than": "more than {gt}",
    "float_type": "a number",
    "finite_number": "a number",
    "greater_than_equal": "at least {ge}",
    "less_than_equal": "at most {le}",
    "literal_error": "{expected}",
    "expected": "{expected}",
}
_PATTERN_OF = {
    "type": "a message type such as std_msgs/msg/String",
    "publish": "a message type such as std_msgs/msg/String",
    "subscribe": "a message type such as std_msgs/msg/String",
    "topic_in": "a type such as std_msgs/msg/String or std_srvs/srv/SetBool",
    "topic_to": "a type such as std_msgs/msg/String or std_srvs/srv/SetBool",
    "service_in": "a service type such as std_srvs/srv/SetBool",
    "service_to": "a service type such as std_srvs/srv/SetBool",
    "action_in": "an action type such as example_interfaces/action/Fibonacci",
    "action_to": "an action type such as example_interfaces/action/Fibonacci",
    "connect": "a locator such as tcp/localhost:7447",
    "prefix": "a namespace such as /robot1",
    "namespace": "a namespace such as /demo",
    "remappings": "the name of a topic, service or node",
    "name": "a platform name of letters, digits, '_', '.' and '-'",
}
_LONGEST_VALUE = 60


def problems_of(error: ValidationError, document: Document) -> list[Problem]:
    """Return one Problem per pydantic error."""
    return [_problem(details, document) for details in error.errors()]


def _problem(details: ErrorDetails, document: Document) -> Problem:
    path: KeyPath = details["loc"]
    if _is_of_key(details):
        named = "a node name" if path[:-2] == ("nodes",) else "a topic name"
        expected = f"{named} of letters, digits and '_'"
        if path[-3] == "remappings":
            expected = _PATTERN_OF["remappings"]
        if details["type"] in ("string_too_long", "string_too_short"):
            expected = _expected(details, path)
        return document.problem(path[:-1], expected, f"'{path[-2]}'")
    if details["type"] == "missing":
        return document.problem(path, f"the key '{path[-1]}'", "no such key")
    if details["type"] == "extra_forbidden":
        return document.problem(path, _known_keys(path), f"the unknown key '{path[-1]}'")
    found = details.get("ctx", {}).get("found", details["input"])
    if "name" in details.get("ctx", {}):
        path = (*path, *details["ctx"]["name"].split("."))
    return document.problem(path, _expected(details, path), describe(found))


def _is_of_key(details: ErrorDetails) -> bool:
    """Return whether an error concerns a key itself, not the value of a key named [key]."""
    path = details["loc"]
    return len(path) > 2 and path[-1] == "[key]" and str(details["input"]) == str(path[-2])


def _expected(details: ErrorDetails, path: KeyPath) -> str:
    if details["type"] == "string_pattern_mismatch":
        if path[0] == "bridge" and path[-1] == "name":
            return "a full name such as /robot1/chatter"
        named = [_PATTERN_OF[key] for key in reversed(path) if key in _PATTERN_OF]
        return named[0] if named else details["msg"]
    template = _EXPECTED.get(details["type"])
    return template.format(**details.get("ctx", {})) if template else details["msg"]


def describe(value: Any) -> str:
    """Return a value with its kind: string 'one'."""
    kinds = {bool: "", int: "", float: "", str: "string ", list: "list ", dict: "mapping "}
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return str(value).lower()
    shown = shorten(_beginning(value), _LONGEST_VALUE)
    return f"{kinds.get(type(value), type(value).__name__ + ' ')}{shown}"


def _beginning(value: Any) -> str:
    """Return the beginning of a value's repr, without formatting a large value."""
    text = ""
    for piece in _pieces(value):
        text += piece
        if len(text) > _LONGEST_VALUE:
            break
    return text


def _pieces(value: Any) -> Iterator[str]:
    if isinstance(value, dict):
        yield "{"
        for index, (key, item) in enumerate(value.items()):
            yield ", " if index else ""
            yield from _pieces(key)
            yield ": "
            yield from _pieces(item)
        yield "}"
    elif isinstance(value, list):
        yield "["
        for index, item in enumerate(value):
            yield ", " if index else ""
            yield from _pieces(item)
        yield "]"
    else:
        yield repr(value[: _LONGEST_VALUE + 1] if isinstance(value, (str, bytes)) else value)


def _known_keys(path: KeyPath) -> str:
    known = list(_section(path).model_fields)
    meant = closest(str(path[-1]), known)
    return f"'{meant}'" if meant else f"one of {', '.join(known)}"


def _section(path: KeyPath) -> type[BaseModel]:
    if path[0] == "bridge" and len(path) > 1:
        parts: dict[int, type[BaseModel]] = {2: BridgeSection, 3: OutsideSection, 4: RouteSection}
        return parts.get(len(path), QosSection)
    if path[0] == "nodes" and len(path) > 3:
        return RespawnSection if path[2] == "respawn" else SchedulingSection
    sections: dict[Any, type[BaseModel]] = {
        "platform": PlatformSection,
        "hosts": HostSection,
        "topics": TopicSection,
        "nodes": NodeSection,
    }
    return sections[path[0]] if len(path) > 1 else MapfileSections
