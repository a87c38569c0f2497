# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Definitions of message, service and action types as text."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.errors.suggestions import did_you_mean
from rmw_manycore_py.ros.ament import interfaces, package_share, packages_with_interfaces

# The part of a line before a comment; # inside quotes does not start one.
_CODE = re.compile(r"""(?:"[^"]*"|'[^']*'|[^#"'])*""")
# A nested message type: the package is optional, and it may be an array.
_NESTED = re.compile(r"(?:(?P<package>\w+)/)?(?P<name>[A-Z]\w*)(?:\[[^]]*\])?\s")


def definition(
    type_name: str, *, comments: bool = True, nested_comments: bool = False
) -> Iterator[str]:
    """Yield the definition of a type, nested types indented below their field."""
    package = type_name.split("/")[0]
    for line in _file(type_name).read_text().splitlines():
        code = _code(line)
        if comments or code:
            yield line.rstrip() if comments else code
        if nested := _NESTED.match(f"{code} "):
            name = f"{nested['package'] or package}/msg/{nested['name']}"
            inner = definition(name, comments=nested_comments, nested_comments=nested_comments)
            yield from (f"\t{inner_line}" if inner_line else "" for inner_line in inner)


def _file(type_name: str) -> Path:
    parts = type_name.split("/")
    if len(parts) != 3 or parts[1] not in ("msg", "srv", "action"):
        raise ManycoreError(
            f"Invalid name '{type_name}': expected package/msg/Name, package/srv/Name or "
            "package/action/Name",
            EXIT_BAD_INPUT,
        )
    share = package_share(parts[0])
    if share is None:
        meant = did_you_mean(parts[0], packages_with_interfaces())
        raise ManycoreError(f"Unknown package '{parts[0]}'{meant}")
    file = share / parts[1] / f"{parts[2]}.{parts[1]}"
    for candidate in (file, file.with_suffix(".idl")):  # a few packages are defined in IDL
        if candidate.is_file():
            return candidate
    meant = did_you_mean(type_name, interfaces(parts[0])) or f": there is no {file}"
    raise ManycoreError(f"Could not find the interface '{type_name}'{meant}")


def _code(line: str) -> str:
    """Return a line without its comment."""
    found = _CODE.match(line)
    return found[0].strip() if found else line.strip()
