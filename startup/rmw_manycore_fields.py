# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Copies buffers into sequences of numbers of messages at once, not element by element.

`msg.data = values` calls `array.array('B', values)` in the generated module. For numpy arrays and
memoryviews, Python does that one element at a time. `install()` lets the name `array` of generated
modules mean a copy of the module `array` whose type, called, copies such values at once; the result
is the same. Message classes stay as they are. See docs/how-to/large_fields.md.

Imports only what Python has already imported: this runs before everything else.
"""

from __future__ import annotations

import sys

from rmw_manycore_loading import change_packages, generated_modules

TYPE_CHECKING = False  # type checkers treat it as typing.TYPE_CHECKING
if TYPE_CHECKING:
    from types import ModuleType
    from typing import Any

VARIABLE = "MANYCORE_FAST_FIELDS"
# Numbers in the byte order of the host, by the codes of memoryview, array.array and numpy
FORMATS = frozenset("bBhHiIlLqQfd")
HALF = "e"  # in numpy only
LONG = {"l": "q", "L": "Q"} if sys.maxsize > 1 << 32 else {}  # the same numbers, named otherwise

_array: ModuleType | None = None  # what generated modules get


def install() -> None:
    """Change generated modules after this process has imported them.

    rmw_manycore.pth decides by `VARIABLE` whether to call this.
    """
    change_packages("fields", (".msg", ".srv", ".action"), change)


def change(package: ModuleType) -> None:
    """Change the generated modules of a package."""
    original = sys.modules.get("array")
    for names in generated_modules(package) if original else ():
        if names.get("array") is original:
            names["array"] = fast_array()


def fast_array() -> ModuleType:
    """Return the copy of the module `array`, or the module itself if ours is not installed."""
    global _array
    if _array is None:
        import array

        _array = array
        try:
            from _rmw_manycore_fields import Array
        except ImportError:  # built without Python bindings
            return array
        _array = type(array)(array.__name__, array.__doc__)
        vars(_array).update(vars(array), array=Array(array.array, convert))
    return _array


def convert(typecode: str, values: Any) -> Any:
    """Return `array.array(typecode, values)`, or None if array.array itself has to do it.

    Some element may be wrong then: array.array raises the right error.
    """
    try:
        source = _source(typecode, values)
        if source is None:
            return None
        import array

        result = array.array(typecode)
        result.frombytes(memoryview(source).cast("B"))
        return result
    except Exception:
        return None


def _source(typecode: str, values: Any) -> Any:
    """Return a contiguous buffer with the elements of the result."""
    import array

    numpy = sys.modules.get("numpy")
    is_numpy = numpy is not None and type(values) in (numpy.ndarray, numpy.memmap)
    if not is_numpy and type(values) not in (memoryview, array.array):
        return None  # iterating over it may give anything
    view = memoryview(values)
    if view.ndim != 1 or not (is_numpy or view.format in FORMATS):
        return None
    if view.contiguous and (view.format == typecode or LONG.get(view.format) == typecode):
        return view
    return numpy and _cast(numpy, numpy.asarray(values), numpy.dtype(typecode))


def _cast(numpy: Any, values: Any, wanted: Any) -> Any:
    """Return `values` as `wanted`, contiguous; None if array.array may refuse an element."""
    if values.dtype.char not in FORMATS | {HALF}:
        return None
    if wanted.kind == "f":
        if values.dtype.kind != "f":
            values = values.astype(numpy.float64)  # as `__float__` does, also on the way to float32
    elif values.dtype.kind == "f":
        return None
    elif not numpy.can_cast(values.dtype, wanted):
        limits = numpy.iinfo(wanted)
        if int(values.min()) < limits.min or int(values.max()) > limits.max:
            return None
    with numpy.errstate(all="ignore"):  # array.array rounds to infinity without a warning
        return numpy.ascontiguousarray(values, wanted)
