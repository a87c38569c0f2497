# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Response that is sent if no reply arrives, in CDR, from the type's description.

rclpy could serialize it, but a process without DDS does not load rclpy.
"""

from __future__ import annotations

import struct
from ast import literal_eval
from collections.abc import Mapping
from typing import Any

from rmw_manycore_bridge.outside import types

# Fields in which ROS responses describe an error.
_REASON_FIELDS = ("message", "status_message", "reason", "error_string", "error_message")
_REJECTED = 1  # action_msgs/srv/CancelGoal: ERROR_REJECTED
_HEAD = b"\0\1\0\0"  # plain CDR, little-endian
# Of type_description_interfaces/msg/FieldType: the type of an element, plus that of its container.
_NESTED, _STRING, _BOUNDED_STRING = 1, 17, 21
_FORMATS = {
    2: "b",
    3: "B",
    4: "h",
    5: "H",
    6: "i",
    7: "I",
    8: "q",
    9: "Q",
    10: "f",
    11: "d",
    13: "B",
    15: "?",
    16: "B",
    18: "I",
    22: "I",  # only the length of an empty wstring
}
_PER_CONTAINER, _ONE, _ARRAY = 48, 0, 1


def empty_answer(service_type: str, reason: str) -> bytes:
    """Return a response of default values, with the reason in a suitable field if any.

    Texts and arrays are empty or zero, whatever the defaults of their type.

    ROS 2 has no error replies; this response keeps a caller from waiting forever.

    :raises ValueError: if the type is installed without a description.
    """
    descriptions = types.fields_of(service_type)
    response = f"{service_type}_Response"
    if response not in descriptions:
        raise ValueError(f"type {service_type} is installed without a description")
    names = {field["name"] for field in descriptions[response]}
    values: dict[str, Any] = dict.fromkeys(_REASON_FIELDS, reason)
    if names >= {"return_code", "goals_canceling"}:
        values["return_code"] = _REJECTED
    writer = _Writer(descriptions)
    writer.message(response, values)
    return _HEAD + writer.data


class _Writer:
    """Serializes messages, all fields but a few with their defaults."""

    def __init__(self, descriptions: Mapping[str, list[dict[str, Any]]]) -> None:
        self._descriptions = descriptions
        self.data = bytearray()

    def message(self, type_name: str, values: Mapping[str, Any]) -> None:
        """Append a message; a value counts for a field that can hold it."""
        for field in self._descriptions[type_name]:
            container, element = divmod(field["type"]["type_id"], _PER_CONTAINER)
            nested = field["type"]["nested_type_name"]
            if container == _ONE:
                value = values.get(field["name"], _number(field["default_value"]))
                self._append(element, nested, value)
            elif container == _ARRAY:
                for _ in range(field["type"]["capacity"]):
                    self._append(element, nested, 0)
            else:
                self._pack("I", 0)  # the length of a sequence

    def _append(self, element: int, type_name: str, value: Any) -> None:
        if element == _NESTED:
            self.message(type_name, {})
        elif element in (_STRING, _BOUNDED_STRING):
            is_text = element == _STRING and isinstance(value, str)
            text = (value.encode() if is_text else b"") + b"\0"
            self._pack("I", len(text))
            self.data += text
        else:
            self._pack(_FORMATS[element], 0 if isinstance(value, str) else value)

    def _pack(self, code: str, value: float) -> None:
        data = struct.pack(f"<{code}", value)
        self.data += bytes(-len(self.data) % len(data)) + data


def _number(text: str) -> float:
    """Return a default that is a number or a bool; 0 for all others."""
    try:
        number = literal_eval(text or "0")
    except (SyntaxError, ValueError):
        return 0
    return number if isinstance(number, (int, float)) else 0
