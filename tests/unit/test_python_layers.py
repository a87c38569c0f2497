# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Every Python package has a layer, and imports go downwards only."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from support.sources.import_graph import (
    ROOT_PACKAGE,
    between_rooms,
    cycle,
    imports_of,
    modules_in,
    rooms_of,
)

pytestmark = pytest.mark.unit

REPOSITORY = Path(__file__).parents[2]
ROOTS = (REPOSITORY, REPOSITORY / "bridge", REPOSITORY / "startup")

# Rooms of the root, lowest first; those of one layer do not see each other. A leading dot: in
# rmw_manycore_py.
LAYERS = [
    ("rmw_manycore_hook", "rmw_manycore_interfaces"),
    ("rmw_manycore_loading",),
    (
        "rmw_manycore_arrays",
        "rmw_manycore_fields",
        "rmw_manycore_program",
        "rmw_manycore_receive",
        ".errors",
        ".examples",
    ),
    (".native", "rmw_manycore_executor"),
    (".process", ".ros", ".trace"),
    (".interfaces", ".platform", ".profile", ".routes"),
    (".mapfile", ".picture", ".transport"),
    (".create", ".emcos", ".launch", ".prediction", ".view", "rmw_manycore_bridge"),
    (".advice", ".recording", "rmw_manycore_py"),
    (".ndt",),
    (".bench",),
    (".papers",),
    (".cli",),
    (".extensions",),
]
# The rooms in one of these, likewise. "": the room itself.
INNER_LAYERS = {
    ".bench": [("", ".nodes"), (".ndt", ".predict", ".scale"), (".advise",)],
    ".cli": [
        (".common", ".topic.meters"),
        (".doctor.report",),
        (
            *(".action", ".bag", ".bench", ".bridge", ".component", ".doctor", ".interface"),
            *(".lifecycle", ".map", ".ndt", ".node", ".param", ".profile", ".service", ".top"),
            *(".topic", ".trace", ".view", ".whill"),
        ),
        ("",),
    ],
    ".launch": [(".processes", ".runs"), ("",)],
    ".mapfile": [(".format",), (".launch_file", ".programs"), (".placing",), ("",), (".mapping",)],
    ".ndt": [
        (".geometry", ".nodes.support"),
        (".files", ".matching", ".messages"),
        ("", ".recordings", ".trust"),
        (".maps", ".replay", ".simulation"),
        (".nodes.scan_matcher",),
        (".nodes",),
    ],
    ".papers": [
        (".reference_system", ".roslite2.laws"),
        (".reference_system.bench", ".roslite2", ".roslite2.course"),
        ("", ".roslite2.laptop", ".roslite2.nodes"),
        (".thesis.matrix", ".thesis.noc"),
        (".thesis",),
        (".roslite.laws", ".roslite.localization"),
        (".roslite",),
        (".roslite.nodes", ".roslite.vehicle"),
        (".roslite.bench",),
    ],
    ".platform": [(".machine",), ("",), (".monitor",)],
    ".prediction": [(".bostan",), ("",)],
    ".recording": [("",), (".play", ".record")],
    ".trace": [("",), (".files",)],
    "rmw_manycore_bridge": [(".outside",), (".fastdds", ".zenoh"), ("",)],
}
MAX_LAYERS = 20


def whole(room: str) -> str:
    return f"{ROOT_PACKAGE}{room}" if room.startswith(".") else room


# Layer at the root, and in the room of the root.
HEIGHTS = {
    whole(room + inner): (layer, inner_layer)
    for layer, rooms in enumerate(LAYERS)
    for room in rooms
    for inner_layer, inners in enumerate(INNER_LAYERS.get(room, [("",)]))
    for inner in inners
}


def room_of_root(room: str) -> str:
    """Return the room of the root in which a room is."""
    parts = room.split(".")
    return ".".join(parts[: 2 if parts[0] == ROOT_PACKAGE else 1])


def is_below(room: str, other: str, heights: Mapping[str, tuple[int, int]]) -> bool:
    """Return whether `room` is in a lower layer than `other`."""
    level = 1 if room_of_root(room) == room_of_root(other) else 0
    return heights[room][level] < heights[other][level]


def not_listed(modules: Mapping[str, Path], heights: Mapping[str, tuple[int, int]]) -> set[str]:
    """Return the rooms without a layer, and the layers' rooms that do not exist."""
    return set(rooms_of(modules).values()) ^ set(heights)


def upward(modules: Mapping[str, Path], heights: Mapping[str, tuple[int, int]]) -> list[str]:
    """Return the imports that leave a room other than for a lower layer."""
    rooms = rooms_of(modules)
    return [
        f"{name} imports {other}"
        for name, imported in imports_of(modules).items()
        for other in sorted(imported)
        if rooms[other] != rooms[name] and not is_below(rooms[other], rooms[name], heights)
    ]


def cycles(modules: Mapping[str, Path]) -> list[list[str]]:
    """Return one cycle of modules and one of rooms, if there are any."""
    imports = imports_of(modules)
    found = (cycle(imports), cycle(between_rooms(imports, rooms_of(modules))))
    return [names for names in found if names]


@pytest.fixture(scope="module")
def ours() -> dict[str, Path]:
    return modules_in(ROOTS)


def test_every_package_and_module_is_listed_once(ours: dict[str, Path]) -> None:
    assert not_listed(ours, HEIGHTS) == set()
    assert len(HEIGHTS) == sum(
        sum(map(len, INNER_LAYERS.get(room, [("",)]))) for layer in LAYERS for room in layer
    )
    assert len(LAYERS) <= MAX_LAYERS


def test_imports_go_downwards_only(ours: dict[str, Path]) -> None:
    assert upward(ours, HEIGHTS) == []


def test_there_is_no_cycle(ours: dict[str, Path]) -> None:
    assert cycles(ours) == []


# A small package, with one room above the other.
TREE = {
    "hook.py": "",
    "rmw_manycore_py/__init__.py": "",
    "rmw_manycore_py/errors.py": "import os",
    "rmw_manycore_py/low/__init__.py": "",
    "rmw_manycore_py/low/one.py": "from rmw_manycore_py import errors",
    "rmw_manycore_py/low/two.py": "from .one import something",
    "rmw_manycore_py/beside/__init__.py": "",
    "rmw_manycore_py/beside/upper/__init__.py": "from rmw_manycore_py import beside",
    "rmw_manycore_py/high/__init__.py": "from rmw_manycore_py.low import one",
    "rmw_manycore_py/high/inner/deep.py": "import rmw_manycore_py.low.two",
}
TREE_HEIGHTS = {
    **dict.fromkeys(("hook", "rmw_manycore_py", "rmw_manycore_py.errors"), (0, 0)),
    "rmw_manycore_py.low": (1, 0),
    "rmw_manycore_py.beside": (1, 0),
    "rmw_manycore_py.beside.upper": (1, 1),
    **dict.fromkeys(("rmw_manycore_py.high", "rmw_manycore_py.high.inner"), (2, 0)),
}
FOR_TYPES = "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    "
IN_FUNCTION = "def f() -> None:\n    "


def tree(directory: Path, changed: Mapping[str, str]) -> dict[str, Path]:
    """Write TREE with some files changed or added."""
    for name, text in {**TREE, **changed}.items():
        path = directory / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return modules_in([directory])


def test_a_sound_tree_passes(tmp_path: Path) -> None:
    modules = tree(tmp_path, {})
    assert not_listed(modules, TREE_HEIGHTS) == set()
    assert upward(modules, TREE_HEIGHTS) == []
    assert cycles(modules) == []


@pytest.mark.parametrize(
    ("file", "room"),
    [
        ("stray.py", "stray"),
        ("other/__init__.py", "other"),
        ("rmw_manycore_py/stray.py", "rmw_manycore_py.stray"),
        ("rmw_manycore_py/_native.pyi", "rmw_manycore_py._native"),
        ("rmw_manycore_py/low/deep/stray.py", "rmw_manycore_py.low.deep"),
    ],
)
def test_what_is_not_listed_is_seen(tmp_path: Path, file: str, room: str) -> None:
    assert not_listed(tree(tmp_path, {file: ""}), TREE_HEIGHTS) == {room}


def test_a_listed_room_that_is_gone_is_seen(tmp_path: Path) -> None:
    heights = {**TREE_HEIGHTS, "rmw_manycore_py.gone": 1}
    assert not_listed(tree(tmp_path, {}), heights) == {"rmw_manycore_py.gone"}


@pytest.mark.parametrize(
    ("file", "text", "imported"),
    [
        ("low/one", "from rmw_manycore_py import high", "high"),
        ("low/one", "import rmw_manycore_py.high", "high"),
        ("low/one", "from ..high.inner import deep", "high.inner.deep"),
        ("low/one", f"{FOR_TYPES}from rmw_manycore_py.high import Thing", "high"),
        ("low/one", f"{IN_FUNCTION}from rmw_manycore_py.high import thing", "high"),
        ("errors", "from rmw_manycore_py.low.one import thing", "low.one"),
        # Beside each other.
        ("beside/upper/__init__", "from rmw_manycore_py.low import one", "low.one"),
        ("high/inner/deep", "from rmw_manycore_py.high import thing", "high"),
    ],
)
def test_an_import_that_does_not_go_downwards_is_seen(
    tmp_path: Path, file: str, text: str, imported: str
) -> None:
    modules = tree(tmp_path, {f"rmw_manycore_py/{file}.py": text})
    importer = f"rmw_manycore_py.{file.removesuffix('/__init__').replace('/', '.')}"
    assert upward(modules, TREE_HEIGHTS) == [f"{importer} imports rmw_manycore_py.{imported}"]


@pytest.mark.parametrize("prefix", ["", FOR_TYPES, IN_FUNCTION])
def test_a_cycle_inside_a_room_is_seen(tmp_path: Path, prefix: str) -> None:
    text = f"{prefix}from rmw_manycore_py.low.two import thing"
    (names,) = cycles(tree(tmp_path, {"rmw_manycore_py/low/one.py": text}))
    assert names[0] == names[-1]
    assert set(names) == {"rmw_manycore_py.low.one", "rmw_manycore_py.low.two"}


def test_a_cycle_of_rooms_without_one_of_modules_is_seen(tmp_path: Path) -> None:
    changed = {"rmw_manycore_py/low/three.py": "from rmw_manycore_py.high import thing"}
    (names,) = cycles(tree(tmp_path, changed))
    assert set(names) == {"rmw_manycore_py.low", "rmw_manycore_py.high"}
