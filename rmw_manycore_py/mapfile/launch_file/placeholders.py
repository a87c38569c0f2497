# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Placeholders for imports that are not supported or not installed; they fail when used."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NoReturn

from typing_extensions import override

from rmw_manycore_py.mapfile.launch_file import unavailable
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError, UnavailableError
from rmw_manycore_py.mapfile.launch_file.substitution import Substitution


class Unsupported:
    """A name of launch that has no stand-in. Annotations may name it; all other use is refused."""

    def __init__(self, dotted: str, find: Callable[[str], Any]) -> None:
        vars(self).update(_dotted=dotted, _find=find)

    def _refuse(self, *_arguments: Any, **_named: Any) -> NoReturn:
        raise LaunchFileError("a name of launch that is supported here", f"'{self._dotted}'")

    def _annotates(self, _other: Any) -> Unsupported:
        return self

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return self._find(f"{self._dotted}.{name}")

    def __repr__(self) -> str:
        return str(self._dotted)

    def __instancecheck__(self, _instance: Any) -> bool:
        return False

    __call__ = __mro_entries__ = __iter__ = __setattr__ = __enter__ = __exit__ = _refuse
    __add__ = __radd__ = __truediv__ = __bool__ = __len__ = __fspath__ = _refuse
    __getitem__ = __or__ = __ror__ = _annotates


class Missing(Substitution):
    """Anything from a Python module that is not installed.

    It may be called and passed on; a node that gets it as a value cannot run here.
    """

    def __init__(self, error: UnavailableError) -> None:
        self._error = error

    def _fail(self, *_arguments: Any) -> NoReturn:
        raise reason_of(self)

    def _more(self, *_arguments: Any, **_named: Any) -> Missing:
        return self

    def __getattr__(self, name: str) -> Missing:
        if name.startswith("__"):
            raise AttributeError(name)
        return self

    @override
    def __str__(self) -> str:
        return unavailable.text_for(self._error)

    @override
    def perform(self, context: LaunchContext) -> str:
        self._fail()

    __call__ = __getitem__ = __enter__ = _more
    __add__ = __radd__ = __truediv__ = __rtruediv__ = _more
    __fspath__ = __str__
    __iter__ = __bool__ = __len__ = __contains__ = __mro_entries__ = _fail

    def __exit__(self, *_exception: Any) -> None:
        """End a `with` block."""


def reason_of(missing: Missing) -> UnavailableError:
    """Return a new error that names what is missing."""
    return UnavailableError(missing._error.expected, missing._error.found)
