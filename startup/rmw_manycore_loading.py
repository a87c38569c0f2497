# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Changes modules of others after this process has loaded them.

Imports only what Python has already imported: this runs before everything else.
"""

from __future__ import annotations

import sys

TYPE_CHECKING = False  # type checkers treat it as typing.TYPE_CHECKING
if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType
    from typing import Any

    Changes = Sequence[Callable[[ModuleType], None]]

METACLASS = "Metaclass_"  # every generated class has one of its own


class ChangesAfterLoading:
    """Import hook that calls functions with modules after they are loaded."""

    def __init__(self, purpose: str, changes_of: Callable[[str], Changes]) -> None:
        self._purpose = purpose
        self._changes_of = changes_of

    @classmethod
    def install(cls, purpose: str, changes_of: Callable[[str], Changes]) -> bool:
        """Install a hook that asks `changes_of` about each name; False if it was there.

        site.py of a virtual environment processes each .pth file twice.
        """
        hooks = (hook for hook in sys.meta_path if isinstance(hook, cls))
        if any(hook._purpose == purpose for hook in hooks):
            return False
        sys.meta_path.insert(0, cls(purpose, changes_of))
        return True

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return what the finders after this one find, with a loader that makes the changes."""
        changes = self._changes_of(name)
        if not changes:
            return None
        for finder in sys.meta_path[sys.meta_path.index(self) + 1 :]:
            spec = finder.find_spec(name, path, target)
            if spec is not None and spec.loader is not None:
                _change_when_loaded(spec.loader, changes)
                return spec
        return None


def _change_when_loaded(loader: Any, changes: Changes) -> None:
    """Patch the loader of this module so that the changes are made after loading."""
    load = loader.exec_module

    def exec_module(module: ModuleType) -> None:
        load(module)
        for change in changes:
            change(module)

    loader.exec_module = exec_module


def change_packages(
    purpose: str, kinds: tuple[str, ...], change: Callable[[ModuleType], None]
) -> None:
    """Call `change` with the packages of generated modules, such as pkg.msg for kind ".msg".

    Those that this process has imported, and others when it does.
    """
    if ChangesAfterLoading.install(purpose, lambda name: (change,) if name.endswith(kinds) else ()):
        for name, module in list(sys.modules.items()):
            if name.endswith(kinds):
                change(module)


def generated_modules(package: ModuleType) -> Iterator[dict[str, Any]]:
    """Yield the names in each generated module of a package: pkg.msg imports pkg.msg._image."""
    for name, module in list(vars(package).items()):
        names: dict[str, Any] = getattr(module, "__dict__", {}) if name.startswith("_") else {}
        if any(key.startswith(METACLASS) for key in names):
            yield names


def refuse_rclpy(variable: str, value: str, *valid: str) -> Callable[[ModuleType], None]:
    """Return a change of rclpy for an invalid value of an environment variable.

    It ends the program with one line; raised before rclpy, Python adds its own traceback.
    """

    def refuse(_: ModuleType) -> None:
        raise SystemExit(f"{variable}='{value}' is not valid: expected {' or '.join(valid)}")

    return refuse
