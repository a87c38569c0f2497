# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Look up message, service and action types by name."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from typing import Any

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.errors.suggestions import did_you_mean
from rmw_manycore_py.ros import ament

KINDS = {"msg": "message", "srv": "service", "action": "action"}


def load_type(name: str, kind: str = "msg") -> Any:
    """Return the class of a type, named package/`kind`/Name or package/Name for short."""
    parts = name.split("/")
    if len(parts) == 2:
        parts.insert(1, kind)
    if len(parts) != 3 or parts[1] != kind or not all(parts):
        raise ManycoreError(
            f"The passed {KINDS[kind]} type is invalid: expected package/{kind}/Name, "
            f"found '{name}'{did_you_mean(name, types_of_kind(kind))}",
            EXIT_BAD_INPUT,
        )
    try:
        return getattr(importlib.import_module(f"{parts[0]}.{parts[1]}"), parts[2])
    except (ImportError, AttributeError) as error:
        meant = did_you_mean("/".join(parts), types_of_kind(kind)) or f": {error}"
        raise ManycoreError(
            f"The passed {KINDS[kind]} type is invalid: '{name}' is not installed{meant}"
        ) from error


def type_name(cls: Any) -> str:
    """Return the name of a message's class: package/msg/Name."""
    package, kind, *_ = cls.__module__.split(".")
    return f"{package}/{kind}/{cls.__name__}"


def types_of_kind(kind: str) -> Iterator[str]:
    """Yield the types of one kind (msg, srv, action), installed or built locally."""
    for package in ament.packages_with_interfaces():
        for name in ament.interfaces(package):
            if name.split("/")[1] == kind:
                yield name
