# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Limits for the length of files and functions."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
LONGEST_FILE = 400
LONGEST_FUNCTION = 60
DIRECTORIES = (
    *("rmw_manycore", "rmw_manycore_py", "bridge", "startup", "cmake", "scripts"),
    *("tests", "docs"),
)
SUFFIXES = {".py", ".cpp", ".hpp", ".c", ".h", ".sh", ".cmake", ".pml"}
NATIVE_FUNCTION = re.compile(r"^(?! *(?:namespace|class|struct|enum|union|extern)\b)\S.*\{$")


def sources(*suffixes: str) -> list[Path]:
    files = (file for name in DIRECTORIES for file in (ROOT / name).rglob("*"))
    # Fixtures are invalid on purpose, some of them as Python.
    return [f for f in files if f.suffix in suffixes and not f.parent.name.startswith("invalid")]


def python_functions(file: Path) -> Iterator[tuple[str, int]]:
    """Yield name and length of each function of a Python file."""
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.name, (node.end_lineno or node.lineno) - node.lineno + 1


def native_functions(file: Path) -> Iterator[tuple[str, int]]:
    """Yield head and length of each definition at the left margin of a C++ file."""
    head, start = "", 0
    for number, line in enumerate(file.read_text().splitlines()):
        if NATIVE_FUNCTION.match(line):
            head, start = line, number
        elif line.startswith("}") and head:
            yield head, number - start + 1
            head = ""


def test_files_are_short() -> None:
    lengths = {file: file.read_text().count("\n") for file in sources(*SUFFIXES)}
    assert lengths
    assert {str(file): n for file, n in lengths.items() if n > LONGEST_FILE} == {}


def test_functions_are_short() -> None:
    lengths = {
        f"{file}: {name}": length
        for suffix, functions in ((".py", python_functions), (".cpp", native_functions))
        for file in sources(suffix)
        for name, length in functions(file)
    }
    assert lengths
    assert {name: n for name, n in lengths.items() if n > LONGEST_FUNCTION} == {}
