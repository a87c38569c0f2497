# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Includes go downwards only."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

NATIVE = Path(__file__).parents[2] / "rmw_manycore"

# Native directories that each one may include, besides itself.
NATIVE_BELOW = {
    "platform": set(),
    "virtual_time": {"platform"},
    "transport": {"platform", "virtual_time"},
    "rmw": {"platform", "virtual_time", "transport"},
    "ndt": {"platform"},
    "python": {"platform", "virtual_time", "transport", "ndt"},
    "bench": {"platform", "virtual_time", "transport", "ndt", "python"},
}
# Headers that others may include beside.
OPEN = {"rmw/borrowing/interface.hpp": {"python"}}  # what the library does for a Python module
# Folders inside these directories, lowest first. Files directly in a directory are its public
# interface, above all of its folders.
FOLDERS = {
    "transport": [
        *("layout", "trace", "registry", "peers", "queue", "transfer", "topic_dsm", "qos"),
        "matching",
        *("notification", "movers", "lifecycle", "waiting", "publisher", "subscription"),
        "timekeeping",
    ],
    "rmw": [
        *("common", "serialization", "borrowing", "events", "context", "qos", "graph", "topics"),
        *("services", "waiting"),
    ],
    "ndt": ["common", "map", "kernel", "optimisation", "search", "matching"],
}
# Folders that others see through one header, and those that see all of it; what they keep to
# themselves is a word in no other file, but for the layout of memory.
DOORS = {"transfer": ("transport/transfer/transfer.hpp", {"movers"}, "landing")}
SEES_ROS = {"rmw", "bench"}
ROS_HEADER = re.compile(r"(rmw|rcl|rcutils|rcpputils|rosidl_\w+|fastcdr|\w+_msgs)/")
# System calls for mapping, pinning and futexes are wrapped in one place.
PLATFORM_ONLY = {"sys/mman.h", "linux/futex.h", "sys/syscall.h", "sched.h"}
CALLS_THE_SYSTEM = {"platform", "bench"}
# Sleeps of libc pass in virtual time, which those of the middleware itself must not move.
VIRTUAL_SLEEP = re.compile(r"\bthis_thread::sleep|\b(clock_)?nanosleep\(|\busleep\(")
SLEEPS_VIRTUALLY = {"virtual_time", "bench"}

INCLUDE = re.compile(r'^\s*#\s*include\s+[<"]([^>"]+)[>"]', re.MULTILINE)


def native_files() -> list[Path]:
    return [path for path in NATIVE.rglob("*") if path.suffix in {".cpp", ".hpp", ".c", ".h"}]


def directory_of(path: Path) -> str:
    return path.relative_to(NATIVE).parts[0]


def test_the_middleware_sleeps_in_wall_time() -> None:
    found = [
        str(path.relative_to(NATIVE))
        for path in native_files()
        if directory_of(path) not in SLEEPS_VIRTUALLY and VIRTUAL_SLEEP.search(path.read_text())
    ]
    assert not found, "use platform/wall_sleep.hpp"


def folder_layer(path: Path) -> int:
    """Return the layer of a file among the folders of its directory."""
    directory, *parts = path.relative_to(NATIVE).parts
    folders = FOLDERS.get(directory, [])
    return folders.index(parts[0]) if folders and len(parts) > 1 else len(folders)


def allowed(path: Path, header: str) -> bool:
    """Return whether the native file `path` may include `header`."""
    directory = directory_of(path)
    if (NATIVE / header).exists():
        included = directory_of(NATIVE / header)
        if included == directory:
            return folder_layer(NATIVE / header) <= folder_layer(path)
        return included in NATIVE_BELOW[directory] or directory in OPEN.get(header, ())
    if ROS_HEADER.match(header):
        return directory in SEES_ROS
    return header not in PLATFORM_ONLY or directory in CALLS_THE_SYSTEM


def test_every_native_directory_has_its_layer() -> None:
    assert {path.name for path in NATIVE.iterdir() if path.is_dir()} == set(NATIVE_BELOW)
    for directory, folders in FOLDERS.items():
        found = {path.name for path in (NATIVE / directory).iterdir() if path.is_dir()}
        assert found - {"standin"} == set(folders)  # C only, includes nothing


def test_native_code_includes_downwards_only() -> None:
    assert native_files()
    wrong = [
        f"{path.relative_to(NATIVE)} includes {header}"
        for path in native_files()
        for header in INCLUDE.findall(path.read_text())
        if not allowed(path, header)
    ]
    assert wrong == []


@pytest.mark.parametrize("folder", DOORS)
def test_a_folder_is_seen_through_its_door(folder: str) -> None:
    door, insiders, secret = DOORS[folder]
    outside = [
        path
        for path in (NATIVE / "transport").rglob("*.?pp")
        if path.parent.name not in {folder, "layout"} | insiders
    ]
    assert outside
    wrong = [
        f"{path.relative_to(NATIVE)}: {line}"
        for path in outside
        for line in path.read_text().splitlines()
        if secret in line.lower() or (f"transport/{folder}/" in line and door not in line)
    ]
    assert wrong == []


@pytest.mark.parametrize(
    ("path", "header"),
    [
        ("platform/futex.hpp", "transport/process.hpp"),
        ("transport/process.hpp", "rmw/init.h"),
        ("transport/registry/registry.cpp", "transport/matching/joining.hpp"),
        ("transport/layout/endpoint.hpp", "transport/process.hpp"),
        ("rmw/common/error.hpp", "rmw/topics/publisher.hpp"),
        ("python/transport/module.cpp", "rmw/common/names.hpp"),
        ("transport/process.cpp", "sys/mman.h"),
    ],
)
def test_an_upward_include_is_seen(path: str, header: str) -> None:
    assert not allowed(NATIVE / path, header)
