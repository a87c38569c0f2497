# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Scripts of a few lines that installers write to start the `main` of a module."""

from __future__ import annotations

import ast
import re
from importlib.metadata import EntryPoint, PackageNotFoundError, distribution
from pathlib import Path

# setuptools, and with it colcon: load_entry_point('package==1.0', 'console_scripts', 'talker')
_LOADED = re.compile(r"load_entry_point\('([\w.-]+)[^']*', 'console_scripts', '([^']+)'\)")


def console_scripts(package: str) -> list[EntryPoint]:
    """Return the nodes of a Python package from pip, which offers them as console scripts."""
    wanted = re.sub(r"[-_.]+", "-", package).lower()
    try:
        found = distribution(wanted)
    except PackageNotFoundError:
        return []
    return [entry for entry in found.entry_points if entry.group == "console_scripts"]


def module_of_script(script: Path) -> str | None:
    """Return the module that such a script starts; None where it is a program of its own."""
    try:
        text = script.read_text(encoding="utf-8")
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    if loaded := _LOADED.search(text):
        package, name = loaded.groups()
        return next((e.module for e in console_scripts(package) if e.name == name), None)
    if any(isinstance(part, (ast.ClassDef, ast.FunctionDef)) for part in tree.body):
        return None
    calls = (node.func for node in ast.walk(tree) if isinstance(node, ast.Call))
    called = {function.id for function in calls if isinstance(function, ast.Name)}
    imports = (part for part in tree.body if isinstance(part, ast.ImportFrom) and not part.level)
    for part in imports:
        if called & {alias.asname or alias.name for alias in part.names}:
            return part.module
    return None
