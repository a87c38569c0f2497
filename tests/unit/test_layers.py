# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Includes go downwards only."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

PACKAGE = Path(__file__).parents[2] / "rmw_manycore_py"
NATIVE = PACKAGE.with_name("rmw_manycore")

# What each native directory may include of the others, besides itself.
NATIVE_BELOW = {
    "platform": set(),
    "transport": {"platform"},
    "rmw": {"platform", "transport"},
    "ndt": {"platform"},
    "python": {"platform", "transport", "ndt", "bench"},
    "bench": {"platform", "transport", "ndt"},
}
# Lowest first. Files directly in transport/ are its face, above all of these.
TRANSPORT_LAYERS = [
    *("layout", "registry", "queue", "topic_dsm", "qos", "matching", "notification"),
    *("lifecycle", "waiting"),
]
SEES_ROS = {"rmw", "bench"}
ROS_HEADER = re.compile(r"(rmw|rcl|rcutils|rcpputils|rosidl_\w+|fastcdr|\w+_msgs)/")
# Mapping, pinning and futexes are wrapped once.
PLATFORM_ONLY = {"sys/mman.h", "linux/futex.h", "sys/syscall.h", "sched.h"}
CALLS_THE_SYSTEM = {"platform", "bench"}

INCLUDE = re.compile(r'^\s*#\s*include\s+[<"]([^>"]+)[>"]', re.MULTILINE)


def native_files() -> list[Path]:
    return [path for path in NATIVE.rglob("*") if path.suffix in {".cpp", ".hpp", ".c", ".h"}]


def directory_of(path: Path) -> str:
    return path.relative_to(NATIVE).parts[0]


def transport_layer(parts: tuple[str, ...]) -> int:
    """Return the layer of a file below transport/, given its path from there."""
    return TRANSPORT_LAYERS.index(parts[0]) if len(parts) > 1 else len(TRANSPORT_LAYERS)


def allowed(path: Path, header: str) -> bool:
    """Tell whether the native file `path` may include `header`."""
    directory = directory_of(path)
    first, *rest = header.split("/")
    if (NATIVE / header).exists():
        if first == directory == "transport":
            own = transport_layer(path.relative_to(NATIVE).parts[1:])
            return transport_layer(tuple(rest)) <= own
        return first == directory or first in NATIVE_BELOW[directory]
    if ROS_HEADER.match(header):
        return directory in SEES_ROS
    return header not in PLATFORM_ONLY or directory in CALLS_THE_SYSTEM


def test_every_native_directory_has_its_layer() -> None:
    assert {path.name for path in NATIVE.iterdir() if path.is_dir()} == set(NATIVE_BELOW)
    folders = {path.name for path in (NATIVE / "transport").iterdir() if path.is_dir()}
    assert folders == set(TRANSPORT_LAYERS)


def test_native_code_includes_downwards_only() -> None:
    assert native_files()
    wrong = [
        f"{path.relative_to(NATIVE)} includes {header}"
        for path in native_files()
        for header in INCLUDE.findall(path.read_text())
        if not allowed(path, header)
    ]
    assert wrong == []


@pytest.mark.parametrize(
    ("path", "header"),
    [
        ("platform/futex.hpp", "transport/process.hpp"),
        ("transport/process.hpp", "rmw/init.h"),
        ("transport/registry/registry.cpp", "transport/matching/matching.hpp"),
        ("transport/layout/endpoint.hpp", "transport/process.hpp"),
        ("python/transport/module.cpp", "rmw/names.hpp"),
        ("transport/process.cpp", "sys/mman.h"),
    ],
)
def test_an_upward_include_is_seen(path: str, header: str) -> None:
    assert not allowed(NATIVE / path, header)
