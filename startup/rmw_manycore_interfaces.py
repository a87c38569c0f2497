# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Makes the packages of `manycore interface build` importable.

`rmw_manycore.pth` calls `find()` in every Python process if such packages exist. A package found
anywhere else takes precedence. See docs/design/interfaces.md.

Imports only what Python has already imported, and constants: this runs before everything else.
"""

from __future__ import annotations

import os
import sys

import rmw_manycore_distribution

TYPE_CHECKING = False  # type checkers treat it as typing.TYPE_CHECKING
if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType

DIRECTORY_VARIABLE = "MANYCORE_INTERFACES"
AMENT_PREFIX_PATH = "AMENT_PREFIX_PATH"
MANIFEST = "manifest.json"


def directory() -> str:
    """Return the directory of packages of all Python versions."""
    named = os.environ.get(DIRECTORY_VARIABLE)
    if named:
        return os.path.abspath(named)
    data = os.environ.get("XDG_DATA_HOME", "")
    if not os.path.isabs(data):  # ignored, as the XDG specification requires
        data = os.path.expanduser("~/.local/share")
    return f"{data}/rmw_manycore/interfaces"


def own_directory() -> str:
    """Return the directory of packages for this Python, its ABI and this ROS distribution."""
    python = f"{sys.implementation.cache_tag}{sys.abiflags}"
    return f"{directory()}/{rmw_manycore_distribution.NAME}-{python}-{os.uname().machine}"


def own_prefix() -> str:
    """Return the install prefix of those packages, with python/, share/ and lib/."""
    return f"{own_directory()}/current"


def find() -> None:
    """Make the packages visible to this process, and to ament in its children."""
    if any(isinstance(finder, _Finder) for finder in sys.meta_path):
        return  # site.py processes each .pth file twice in a virtual environment
    sys.meta_path.insert(0, _Finder())
    prefixes = os.environ.get(AMENT_PREFIX_PATH)
    # Do not create the variable: ament tools need it anyway, and CMake would assume a sourced ROS.
    if prefixes and own_prefix() not in prefixes.split(os.pathsep):
        os.environ[AMENT_PREFIX_PATH] = f"{prefixes}{os.pathsep}{own_prefix()}"


class _Finder:
    """Finds packages of the prefix that no other finder finds.

    It comes first in sys.meta_path: otherwise a directory of definitions in the working directory,
    a namespace package to Python, would hide the package built from it.
    """

    @staticmethod
    def find_spec(
        name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        place = f"{own_prefix()}/python"
        if path is not None or not os.path.isfile(f"{place}/{name}/__init__.py"):
            return None
        for finder in sys.meta_path:
            spec = None if isinstance(finder, _Finder) else finder.find_spec(name, path, target)
            if spec is not None and spec.origin is not None:
                return spec
        from importlib.machinery import PathFinder

        return PathFinder.find_spec(name, [place])


def check(package: str) -> None:
    """Raise ImportError if a type used by a built package has changed since.

    The package would access memory with an outdated layout.
    """
    import json
    import shlex

    with open(f"{own_prefix()}/share/{package}/{MANIFEST}") as file:
        manifest = json.load(file)
    for name, expected in manifest["dependencies"].items():
        if (found := hash_of(name)) != expected:
            source = shlex.quote(manifest["source"])
            raise ImportError(
                f"package '{package}' in {own_prefix()} was built for {name} with the hash "
                f"{expected}, but found {found or 'no such type'}: run "
                f"`manycore interface build {source}` again, or "
                f"`manycore interface remove {package}`"
            )


def hash_of(name: str) -> str | None:
    """Return the hash (REP 2016) of an installed or built type such as std_msgs/msg/Header."""
    import json

    package, kind, type_name = name.split("/")
    for prefix in _prefixes():
        try:
            with open(f"{prefix}/share/{package}/{kind}/{type_name}.json") as file:
                return str(json.load(file)["type_hashes"][0]["hash_string"])
        except OSError:
            continue
    return None


def _prefixes() -> Iterator[str]:
    named = os.environ.get(AMENT_PREFIX_PATH, "").split(os.pathsep)
    yield from (prefix for prefix in named if prefix and prefix != own_prefix())
    yield sys.prefix
    yield own_prefix()
