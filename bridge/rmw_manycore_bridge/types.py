# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The classes and hashes of installed types, which may be parts of actions."""

from __future__ import annotations

import importlib
import json
from typing import Any

from rmw_manycore_py.ros.ament import package_share

# Parts of an action, and where rclpy keeps them in the action's class.
_ACTION_PARTS = {
    "SendGoal": "SendGoalService",
    "GetResult": "GetResultService",
    "FeedbackMessage": "FeedbackMessage",
}


def load(name: str) -> Any:
    """Return the class of "package/msg/Name" and the like; ImportError says what is missing."""
    package, kind, type_name = name.split("/")
    try:
        module = importlib.import_module(f"{package}.{kind}")
    except ModuleNotFoundError as error:
        raise ImportError(
            f"type {name} is not installed: there is no package '{package}' with it"
        ) from error
    whole, _, part = type_name.rpartition("_")
    if kind == "action" and part in _ACTION_PARTS:
        return getattr(getattr(module, whole).Impl, _ACTION_PARTS[part])
    try:
        return getattr(module, type_name)
    except AttributeError as error:
        raise ImportError(f"package '{package}' has no type {name}") from error


def hash_of(name: str) -> str:
    """Return a type's hash (REP 2016), or nothing where the installed package has none."""
    package, kind, type_name = name.split("/")
    whole = type_name.rpartition("_")[0] if kind == "action" else type_name
    share = package_share(package)
    description = share / kind / f"{whole}.json" if share else None
    if description is None or not description.is_file():
        return ""
    data = json.loads(description.read_text())
    hashes = {entry["type_name"]: entry["hash_string"] for entry in data["type_hashes"]}
    return str(hashes.get(name, ""))
