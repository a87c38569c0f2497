# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Finds programs of nodes: modules, scripts, executables of packages, commands."""

from __future__ import annotations

import importlib.util
import os
import re
import shlex
import shutil
import site
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path

from rmw_manycore_program import own_program
from rmw_manycore_py.mapfile.programs.entry_script import (
    console_scripts,
    installed_script,
    module_of_script,
)
from rmw_manycore_py.ros import ament

_TITLED = re.compile('"""(.*?)"""; ')  # code of an entry point


@dataclass(frozen=True)
class Program:
    """Command that starts a program; its source if it is Python; words to put before it."""

    argv: tuple[str, ...]
    source: Path | None = None
    prefix: tuple[str, ...] = ()


def find_script(file: Path) -> Program:
    """Return the program of a Python file."""
    return Program((sys.executable, str(file)), file)


def find_module(module: str, directory: Path) -> Program | None:
    """Return the program of a Python module, without importing it.

    Nodes of rmw_manycore are the installed ones, also in a checkout, whose sources lack the native
    modules.
    """
    is_own = module.split(".")[0] == "rmw_manycore_py"
    spec = _module_spec(module, None if is_own else directory)
    if spec is not None and spec.submodule_search_locations is not None:
        spec = _module_spec(f"{module}.__main__", None if is_own else directory)
    if spec is None:
        return None
    argv = own_program(module) if is_own else (sys.executable, "-m", module)
    return Program(argv, _python_source(spec))


def _python_source(spec: ModuleSpec | None) -> Path | None:
    origin = spec.origin if spec else None
    return Path(origin) if origin and origin.endswith(".py") else None


def _module_spec(module: str, directory: Path | None) -> ModuleSpec | None:
    """Find a module without importing its parent packages, which could have side effects."""
    first, *rest = module.split(".")
    spec = PathFinder.find_spec(first, [str(directory)]) if directory else None
    spec = spec or _top_level_spec(first)
    name = first
    for part in rest:
        if spec is None or spec.submodule_search_locations is None:
            return None
        name = f"{name}.{part}"
        spec = PathFinder.find_spec(name, list(spec.submodule_search_locations))
    return spec


def _top_level_spec(name: str) -> ModuleSpec | None:
    try:
        return importlib.util.find_spec(name)
    except (ValueError, ImportError):
        return None


def find_executable(package: str, executable: str) -> Program | None:
    """Return the program that `ros2 run package executable` starts."""
    for prefix in ament.prefixes():
        path = prefix / "lib" / package / executable
        if os.path.isfile(path) and os.access(path, os.X_OK):
            return _of_file(path)
    return _entry_point(package, executable)


def command_text(command: Sequence[str]) -> str:
    """Return a command line for reading: an entry point by its package and executable."""
    words = list(command)
    for at, code in enumerate(words):
        if at > 1 and words[at - 1] == "-c" and (title := _TITLED.match(code)):
            return shlex.join([*words[: at - 2], *title[1].split(), *words[at + 1 :]])
    return shlex.join(words)


def find_component(package: str, plugin: str) -> Program | None:
    """Return the program that starts only the component `plugin`.

    Such programs come from rclcpp_components_register_node() and contain the name of the
    component's factory, which is the only way to identify them.
    """
    factory = f"NodeFactoryTemplate<{plugin}>".encode()
    for prefix in ament.prefixes():
        directory = prefix / "lib" / package
        for path in sorted(directory.glob("*")) if directory.is_dir() else ():
            is_program = path.is_file() and os.access(path, os.X_OK) and ".so" not in path.suffixes
            if is_program and factory in path.read_bytes():
                return _of_file(path)
    return None


def executables_of(package: str) -> list[str]:
    """Return the names of all executables of a package."""
    files = (
        path
        for prefix in ament.prefixes()
        if os.path.isdir(directory := prefix / "lib" / package)
        for path in directory.glob("*")
        if path.is_file() and os.access(path, os.X_OK) and ".so" not in path.suffixes
    )
    return sorted(
        {path.name for path in files} | {entry.name for entry in console_scripts(package)}
    )


def find_command(words: Sequence[str], directory: Path) -> Program | None:
    """Return the program of a command; its path is relative to `directory`.

    A bare name is first searched beside this interpreter: `python3` is the one with ROS, whether
    or not its environment is activated.
    """
    first = Path(os.path.expanduser(words[0]))
    found = str(directory / first) if len(first.parts) > 1 else words[0]
    own = Path(sys.executable).parent
    path = shutil.which(found, path=f"{own}{os.pathsep}{os.environ.get('PATH', os.defpath)}")
    if path is None or unfound_script(words, directory):
        return None
    return Program((path, *words[1:]), _source_of(words, directory))


def unfound_script(words: Sequence[str], directory: Path) -> str | None:
    """Return the file or module that Python is to run, if it does not exist."""
    if len(words) < 2 or not _is_python(words[0]):
        return None
    if words[1] == "-m" and len(words) > 2 and words[0] == Path(words[0]).name:
        return None if find_module(words[2], directory) else words[2]
    is_missing = words[1].endswith(".py") and not os.path.isfile(directory / words[1])
    return words[1] if is_missing else None


def _is_python(word: str) -> bool:
    return re.fullmatch(r"python[\d.]*", Path(word).name) is not None


def _source_of(words: Sequence[str], directory: Path) -> Path | None:
    """Return the source of `python3 -m module` and `python3 file.py`."""
    if len(words) < 2 or not _is_python(words[0]):
        return None
    if words[1] == "-m" and len(words) > 2:
        module = find_module(words[2], directory)
        return module.source if module else None
    file = directory / words[1]
    return file if file.suffix == ".py" and os.path.isfile(file) else None


def _of_file(path: Path) -> Program:
    with path.open("rb") as file:
        first_line = file.readline(200)
    if not re.match(rb"#!.*\bpython", first_line):
        return Program((str(path),))
    module = module_of_script(path)
    source = _python_source(_module_spec(module, path.parent)) if module else None
    argv = (sys.executable, str(path)) if _runs_in_this_python(first_line) else (str(path),)
    return Program(argv, source or path)


def _runs_in_this_python(first_line: bytes) -> bool:
    """Return whether a script is for `env python3`, or for the Python that this one extends.

    The first finds this environment's only if it is activated; in the second, which is that of an
    installed ROS 2, the start-up hooks of this environment would be missing.
    """
    if b"/env " in first_line:
        return True
    interpreter = Path(os.fsdecode(first_line[2:].split()[0]))
    is_extended = sys.prefix != sys.base_prefix and sys.base_prefix in site.PREFIXES
    is_of_venv = (interpreter.parent.parent / "pyvenv.cfg").exists()
    ours = os.path.realpath(sys.executable)
    return is_extended and not is_of_venv and os.path.realpath(interpreter) == ours


def _entry_point(package: str, executable: str) -> Program | None:
    entry = next((e for e in console_scripts(package) if e.name == executable), None)
    if entry is None:
        return None
    source = _python_source(_module_spec(entry.module, None))
    if (script := installed_script(package, executable)) is not None:
        return Program((str(script),), source)
    attribute = entry.attr.split(".")[0]
    # Like the script that pip would write, without the working directory in sys.path. The docstring
    # labels the process.
    code = (
        f'"""{package} {executable}"""; import sys; sys.path[:] = filter(None, sys.path); '
        f"from {entry.module} import {attribute}; sys.exit({entry.attr}())"
    )
    return Program((sys.executable, "-c", code), source)
