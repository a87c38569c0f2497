# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Finds installed ROS packages: ament index of a ROS 2 installation, or of PyPI wheels."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from rmw_manycore_interfaces import AMENT_PREFIX_PATH, own_prefix


def prefixes() -> list[Path]:
    """Return the install prefixes in order; the user's built packages come last."""
    return [*_installed_prefixes(), Path(own_prefix())]


def _installed_prefixes() -> list[Path]:
    """Return the prefixes of the environment, then that of this Python."""
    environment = os.environ.get(AMENT_PREFIX_PATH, "").split(os.pathsep)
    named = dict.fromkeys([*filter(None, environment), sys.prefix])
    return [Path(prefix) for prefix in named if prefix != own_prefix()]


def is_installed(package: str) -> bool:
    """Return whether a package with types is installed, not counting locally built ones."""
    entry = Path("share/ament_index/resource_index/rosidl_interfaces", package)
    return any((prefix / entry).is_file() for prefix in _installed_prefixes())


def find_resource(kind: str, name: str) -> tuple[Path, Path] | None:
    """Return the prefix and the file of a resource index entry; None if missing."""
    for prefix in prefixes():
        entry = prefix / "share/ament_index/resource_index" / kind / name
        if os.path.isfile(entry):
            return prefix, entry
    return None


def package_prefix(package: str) -> Path | None:
    """Return the install prefix of a package; None if it is not installed."""
    found = find_resource("packages", package)
    return found[0] if found else None


def package_share(package: str) -> Path | None:
    """Return the share directory of a package; None if it is not installed."""
    prefix = package_prefix(package)
    return prefix / "share" / package if prefix else None


def packages_with_interfaces() -> list[str]:
    """Return the packages that define message, service or action types."""
    return resource_names("rosidl_interfaces")


def resource_names(kind: str) -> list[str]:
    """Return the names of a kind of resource index entries."""
    directories = (p / "share/ament_index/resource_index" / kind for p in prefixes())
    found = {entry.name for d in directories if d.is_dir() for entry in d.iterdir()}
    return sorted(found)


def interfaces(package: str) -> frozenset[str]:
    """Return the types of a package, e.g. std_msgs/msg/String."""
    found = find_resource("rosidl_interfaces", package)
    return _interfaces(package, found[1]) if found else frozenset()


@cache
def _interfaces(package: str, entry: Path) -> frozenset[str]:
    return frozenset(f"{package}/{Path(line).with_suffix('')}" for line in _lines(entry))


def _lines(entry: Path) -> Iterator[str]:
    return (line.strip() for line in entry.read_text().splitlines() if line.strip())


def canonical_type(name: str) -> str:
    """Return a type as package/msg/Name; accepts the spellings of ROS 1 and of the papers."""
    parts = [part for part in re.split(r"/|::", name.strip()) if part]
    if len(parts) == 2:
        parts.insert(1, "msg")
    if len(parts) != 3:
        return name
    wanted = "/".join(parts)
    folded = wanted.replace("_", "").lower()
    installed = interfaces(parts[0])
    if wanted in installed:
        return wanted
    alike = [known for known in installed if known.replace("_", "").lower() == folded]
    parts[2] = parts[2][:1].upper() + parts[2][1:]
    return alike[0] if len(alike) == 1 else "/".join(parts)
