# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Types of messages, services and actions by their names."""

from __future__ import annotations

import importlib
from typing import Any

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

KINDS = {"msg": "message", "srv": "service", "action": "action"}


def load_type(name: str, kind: str = "msg") -> Any:
    """Return the class of a type: package/`kind`/Name, or package/Name for short."""
    parts = name.split("/")
    if len(parts) == 2:
        parts.insert(1, kind)
    if len(parts) != 3 or parts[1] != kind or not all(parts):
        raise ManycoreError(
            f"'{name}' is no {KINDS[kind]} type: expected package/{kind}/Name", EXIT_BAD_INPUT
        )
    try:
        return getattr(importlib.import_module(f"{parts[0]}.{parts[1]}"), parts[2])
    except (ImportError, AttributeError) as error:
        raise ManycoreError(f"{KINDS[kind]} type '{name}' is not installed: {error}") from error


def type_name(cls: Any) -> str:
    """Return the name of a message's class: package/msg/Name."""
    package, kind, *_ = cls.__module__.split(".")
    return f"{package}/{kind}/{cls.__name__}"
