# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Leaves large arrays of messages where they are, instead of copying them to and from rclpy.

rclpy converts messages by functions that each generated class gets when its type support is
imported. `install()` lets classes with sequences of numbers get functions of ours, which leave the
large ones out of upstream's. See docs/how-to/zero_copy.md.

Imports only what Python has already imported: this runs before everything else.
"""

from __future__ import annotations

import os
import sys

from rmw_manycore_loading import (
    METACLASS,
    ChangesAfterLoading,
    change_packages,
    generated_modules,
    refuse_rclpy,
)

TYPE_CHECKING = False  # type checkers treat it as typing.TYPE_CHECKING
if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import ModuleType
    from typing import Any

    from _rmw_manycore_arrays import Field

VARIABLE = "MANYCORE_ZERO_COPY"
SOLE, READ_ONLY, OFF = "sole", "read_only", "off"
NESTED = "/"  # in the name of a message type; sequences have brackets, too
SEQUENCE = "sequence<"
NUMBERS = (
    *("int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64"),
    *("float", "double"),
)
TYPECODES = dict(zip(NUMBERS, "bBhHiIqQfd", strict=True))

_native: Any = None  # our compiled module; False if there is none for this Python


def install() -> None:
    """Change generated classes when their type support is imported.

    rmw_manycore.pth calls this unless `VARIABLE` is `OFF`.
    """
    chosen = os.environ.get(VARIABLE) or SOLE
    if chosen in (SOLE, READ_ONLY):
        change_packages("arrays", (".msg",), change)
    else:
        refusal = (refuse_rclpy(VARIABLE, chosen, SOLE, READ_ONLY, OFF),)
        ChangesAfterLoading.install("arrays", lambda name: refusal if name == "rclpy" else ())


def change(package: ModuleType) -> None:
    """Change the generated classes of a package."""
    for names in generated_modules(package):
        for key, metaclass in list(names.items()):
            if key.startswith(METACLASS) and hasattr(metaclass, "__import_type_support__"):
                message = names.get(key[len(METACLASS) :])
                if type(message) is metaclass:
                    _change_class(message, metaclass)


def _change_class(message: Any, metaclass: Any) -> None:
    original = metaclass.__import_type_support__

    def import_type_support() -> None:
        original()
        if metaclass._TYPE_SUPPORT is not None:
            _replace_converters(message)

    if metaclass._TYPE_SUPPORT is not None:
        _replace_converters(message)
    metaclass.__import_type_support__ = staticmethod(import_type_support)


def _replace_converters(message: Any) -> None:
    fields = list(number_fields(message))
    if fields and (native := _compiled()):
        native.replace_converters(message, fields, os.environ.get(VARIABLE) == READ_ONLY)


def number_fields(
    message: Any, prefix: str = "", classes: tuple[type, ...] = ()
) -> Iterator[Field]:
    """Yield the fields that are kept as array.array, also those of nested messages."""
    types = message._fields_and_field_types
    for (name, type_), slot_type in zip(types.items(), message.SLOT_TYPES, strict=False):
        if type_.startswith(SEQUENCE):
            typecode = TYPECODES.get(type_[len(SEQUENCE) : -1].partition(",")[0])
            if typecode:
                yield prefix + name, typecode, classes
        elif NESTED in type_ and not type_.endswith("]"):
            module = sys.modules.get(".".join(slot_type.namespaces))
            nested = getattr(module, slot_type.name, None)
            if nested is not None:
                yield from number_fields(nested, f"{prefix}{name}.", (*classes, nested))


def _compiled() -> Any:
    """Return our compiled module, or False; where Python differs, tell why once."""
    global _native
    if _native is None:
        try:
            import _rmw_manycore_arrays as native
        except ImportError:  # built without Python bindings
            _native = False
            return _native
        _native = native
        if fault := native.find_fault():
            sys.stderr.write(f"rmw_manycore: large messages are copied: {fault}\n")
            _native = False
        else:
            os.register_at_fork(
                before=native.before_fork,
                after_in_parent=native.after_fork_in_parent,
                after_in_child=native.after_fork_in_child,
            )
    return _native
