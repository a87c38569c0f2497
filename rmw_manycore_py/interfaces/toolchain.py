# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Compilers, headers and libraries for generated code."""

from __future__ import annotations

import os
import shlex
import shutil
import sysconfig
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ros import ament

# Packages whose headers are included by generated code, and libraries it is linked with.
_HEADERS = (
    *("rcutils", "rmw", "rosidl_dynamic_typesupport", "rosidl_runtime_c", "rosidl_runtime_cpp"),
    *("rosidl_typesupport_c", "rosidl_typesupport_fastrtps_c", "rosidl_typesupport_fastrtps_cpp"),
    *("rosidl_typesupport_interface", "rosidl_typesupport_introspection_c", "fastcdr"),
)
_LIBRARIES = (
    *("rosidl_runtime_c", "rosidl_typesupport_c", "rosidl_typesupport_fastrtps_c"),
    *("rosidl_typesupport_fastrtps_cpp", "rosidl_typesupport_introspection_c", "fastcdr"),
    *("rcutils", "rmw"),
)


@dataclass(frozen=True)
class Toolchain:
    """Compiler commands and the prefix of ROS."""

    c: tuple[str, ...]
    cpp: tuple[str, ...]
    ros: Path
    python_headers: Path
    numpy_headers: Path

    @property
    def includes(self) -> list[Path]:
        """Return the include directories of ROS."""
        root = self.ros / "include"
        return [root, *(root / package for package in _HEADERS if (root / package).is_dir())]

    @property
    def libraries(self) -> list[Path]:
        """Return the ROS libraries to link with."""
        return [self.ros / "lib" / f"lib{name}.so" for name in _LIBRARIES]


def find_toolchain() -> Toolchain:
    """Find everything a build needs; raise ManycoreError with install instructions if missing."""
    ros = _prefix_with("include/rosidl_runtime_c")
    for name in ("rosidl_adapter", "rosidl_generator_py", "rosidl_typesupport_fastrtps_c"):
        if not (ros / "share" / name).is_dir():
            raise _missing(f"the generators of rosidl, here {name}", _PIP)
    python = Path(sysconfig.get_path("include"))
    if not (python / "Python.h").is_file():
        raise _missing(f"the headers of Python, {python}/Python.h", "apt install python3-dev")
    return Toolchain(
        c=_compiler("CC", ("cc", "gcc", "clang")),
        cpp=_compiler("CXX", ("c++", "g++", "clang++")),
        ros=ros,
        python_headers=python,
        numpy_headers=_numpy_headers(),
    )


_PIP = "pip install --force-reinstall rmw-manycore"


def _numpy_headers() -> Path:
    import numpy

    return Path(numpy.get_include())


def _prefix_with(name: str) -> Path:
    for prefix in ament.prefixes():
        if (prefix / name).is_dir():
            return prefix
    raise _missing("the headers of ROS 2", _PIP)


def _compiler(variable: str, names: Iterable[str]) -> tuple[str, ...]:
    words = tuple(shlex.split(os.environ.get(variable, "")))
    if words:
        if shutil.which(words[0]):
            return words
        raise ManycoreError(f"{variable}={words[0]}: expected a compiler, found no such program")
    for name in names:
        if shutil.which(name):
            return (name,)
    language = "C++" if variable == "CXX" else "C"
    text = f"a {language} compiler ({', '.join(names)} in PATH)"
    raise _missing(text, f"apt install g++, or set {variable}")


def _missing(what: str, cure: str) -> ManycoreError:
    return ManycoreError(f"building interfaces needs {what}: {cure}")
