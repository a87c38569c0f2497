# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Classes, descriptions and hashes of installed types, including parts of actions."""

from __future__ import annotations

import importlib
import json
from typing import Any

from rmw_manycore_py.ros.ament import package_share

# Parts of an action, and their attributes in rclpy's action class.
_ACTION_PARTS = {
    "SendGoal": "SendGoalService",
    "GetResult": "GetResultService",
    "FeedbackMessage": "FeedbackMessage",
}


def load(name: str) -> Any:
    """Return the class of a type such as "package/msg/Name"; raise ImportError if missing."""
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
    """Return the type hash (REP 2016); empty if the installed package has none."""
    hashes = {entry["type_name"]: entry["hash_string"] for entry in _described(name, "type_hashes")}
    return str(hashes.get(name, ""))


def fields_of(name: str) -> dict[str, list[dict[str, Any]]]:
    """Return the fields of all types that a type refers to, by type; empty if it has none.

    A field is an entry of type_description_interfaces/msg/Field.
    """
    found = _described(name, "type_description_msg") or {"referenced_type_descriptions": []}
    return {entry["type_name"]: entry["fields"] for entry in found["referenced_type_descriptions"]}


def _described(name: str, key: str) -> Any:
    """Return a part of the description that is installed with a type; empty without one."""
    package, kind, type_name = name.split("/")
    whole = type_name.rpartition("_")[0] if kind == "action" else type_name
    share = package_share(package)
    description = share / kind / f"{whole}.json" if share else None
    if description is None or not description.is_file():
        return {}
    return json.loads(description.read_text())[key]
