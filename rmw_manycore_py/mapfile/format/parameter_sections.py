# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Sections of a ROS 2 parameter file that apply to a node."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def sections_of(data: Any, full_name: str) -> list[Mapping[str, Any]]:
    """Return the sections that apply to a node, wildcards first."""
    namespace, _, name = full_name.rpartition("/")
    found = []
    for key in ("/**", f"{namespace}/*", name if not namespace else None, full_name):
        section = data.get(key) if isinstance(data, Mapping) and key is not None else None
        if section is None and key == full_name and isinstance(data, Mapping):
            section = _nested(data, full_name)
        if isinstance(section, Mapping) and isinstance(section.get("ros__parameters"), Mapping):
            found.append(section["ros__parameters"])
    return found


def _nested(data: Mapping[str, Any], full_name: str) -> Any:
    """Look up a name written as nested namespaces."""
    section: Any = data
    for part in full_name.strip("/").split("/"):
        section = section.get(part, section.get(f"/{part}")) if isinstance(section, dict) else None
    return section
