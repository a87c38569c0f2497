# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The public Python API: what it exports, what importing it loads, and what the examples use."""

from __future__ import annotations

import ast
import importlib
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
PUBLIC = (
    *("rmw_manycore_py", "rmw_manycore_py.transport", "rmw_manycore_py.emcos"),
    "rmw_manycore_py.ndt",
)
LOADED = "import sys, {module}; print(*sorted(sys.modules))"


def loaded_by(module: str) -> set[str]:
    """Return what is loaded once a module was imported, beside what Python starts with."""
    command = [sys.executable, "-c", LOADED.format(module=module)]
    found, before = (
        subprocess.run(words, check=True, capture_output=True, text=True).stdout.split()
        for words in (command, [sys.executable, "-c", LOADED.format(module="importlib")])
    )
    return set(found) - set(before)


def test_the_root_package_loads_nothing_else() -> None:
    loaded = loaded_by("rmw_manycore_py")
    assert {name for name in loaded if name.startswith("rmw_manycore")} == {"rmw_manycore_py"}
    assert not loaded & {"numpy", "pydantic", "yaml"}


def test_names_are_listed_before_they_are_loaded() -> None:
    code = "import rmw_manycore_py as m; print(*sorted({*m.__all__} & {*dir(m)} - {*vars(m)}))"
    listed = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True
    ).stdout.split()
    assert listed == importlib.import_module("rmw_manycore_py").__all__


@pytest.mark.parametrize("module", PUBLIC)
def test_no_part_of_it_loads_ros(module: str) -> None:
    assert {
        name for name in loaded_by(module) if name.split(".")[0] in ("rclpy", "std_msgs")
    } == set()


def test_the_transport_is_without_mapfiles() -> None:
    loaded = loaded_by("rmw_manycore_py.transport")
    assert "pydantic" not in loaded
    assert not any(name.startswith("rmw_manycore_py.mapfile") for name in loaded)


@pytest.mark.parametrize("module", PUBLIC)
def test_all_names_what_there_is(module: str) -> None:
    public = importlib.import_module(module)
    assert public.__all__ == sorted(public.__all__)
    for name in public.__all__:
        assert getattr(public, name).__doc__, name
    assert set(public.__all__) <= set(dir(public))
    assert public.__doc__
    with pytest.raises(AttributeError, match="no attribute 'no_such_thing'"):
        public.no_such_thing  # noqa: B018 - the look is the test


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_need_nothing_private(example: Path) -> None:
    tree = ast.parse(example.read_text())
    aliases = {}
    for statement in ast.walk(tree):
        if isinstance(statement, ast.ImportFrom) and statement.module in PUBLIC:
            for alias in statement.names:
                module = f"{statement.module}.{alias.name}"
                assert module in PUBLIC, module
                aliases[alias.asname or alias.name] = importlib.import_module(module)
        elif isinstance(statement, ast.Import):
            for alias in statement.names:
                if alias.name.startswith("rmw_manycore"):
                    assert alias.name in PUBLIC
                    aliases[alias.asname or alias.name] = importlib.import_module(alias.name)
    used = [
        (node.value.id, node.attr)
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name)
    ]
    assert aliases
    for name, attribute in used:
        assert not attribute.startswith("_")
        assert name not in aliases or attribute in aliases[name].__all__, attribute


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_say_how_they_are_run(example: Path) -> None:
    text = ast.get_docstring(ast.parse(example.read_text())) or ""
    assert f"    python examples/{example.name}" in text


def test_examples_are_numbered_without_a_gap() -> None:
    for number, path in enumerate(EXAMPLES, 1):
        assert path.name.startswith(f"{number:02}_")
