# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Python modules and files that a launch file uses although this machine lacks them."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any, NoReturn

from typing_extensions import override

from rmw_manycore_py.mapfile.launch_file import unavailable
from rmw_manycore_py.mapfile.launch_file.frame import calling_frame, is_in_try, is_launch_file
from rmw_manycore_py.mapfile.launch_file.placeholders import Missing
from rmw_manycore_py.mapfile.launch_file.refusals import UnavailableError


class MissingFinder(Loader, MetaPathFinder):
    """Makes modules that are not installed, for launch files that import them.

    An import in a `try`, or in another module, fails as it does elsewhere.
    """

    def __init__(self) -> None:
        self._made: set[str] = set()

    @override
    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        top, _, inner = fullname.partition(".")
        frame = calling_frame()
        if inner and top not in self._made:  # the package is installed, this module is not
            return None
        if not is_launch_file(frame) or is_in_try(frame):
            return None
        self._made.add(top)
        return ModuleSpec(fullname, self, is_package=True)

    @override
    def exec_module(self, module: ModuleType) -> None:
        name = module.__name__.partition(".")[0]
        missing = Missing(
            UnavailableError(f"the Python module '{name}'", "that it is not installed")
        )

        def find_in_module(attribute: str) -> Any:
            if attribute.startswith("__"):
                raise AttributeError(attribute)
            return missing

        vars(module)["__getattr__"] = find_in_module


class MissingFile:
    """A file that cannot be read here: its content is a placeholder text."""

    def __init__(self, error: UnavailableError) -> None:
        self._error = error

    def __enter__(self) -> MissingFile:
        return self

    def __exit__(self, *_exception: Any) -> None:
        """End a `with` block."""

    def close(self) -> None:
        """Do nothing."""

    def read(self, _size: int = -1) -> str:
        """Return the text to a launch file; raise the error to others, such as a parser."""
        if is_launch_file(calling_frame()):
            return unavailable.text_for(self._error)
        raise self._error

    def __iter__(self) -> NoReturn:
        raise self._error

    readline = readlines = __iter__


def open_or_missing(file: Any, mode: str = "r", *arguments: Any, **named: Any) -> Any:
    """Open a file, or return a MissingFile if it cannot be read here."""
    try:
        return open(file, mode, *arguments, **named)
    except OSError as error:
        if set(mode) & set("wax+") or is_in_try(calling_frame()):
            raise
        known = unavailable.error_in(str(file))
        reason = f"'{file}': {error.strerror}"
        return MissingFile(known or UnavailableError("a readable file", reason))
