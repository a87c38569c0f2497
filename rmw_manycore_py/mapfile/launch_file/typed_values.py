# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Typed values: how launch converts texts and checks values (launch.utilities.type_utils)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import yaml

from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError
from rmw_manycore_py.mapfile.launch_file.substitution import Substitution, perform

SCALARS = (int, float, bool, str)


@dataclass(frozen=True)
class Kind:
    """Type of a value: a scalar, or a list of one kind of scalars."""

    scalar: type
    is_list: bool = False

    def __str__(self) -> str:
        return f"list of {self.scalar.__name__}" if self.is_list else self.scalar.__name__


BOOL, FLOAT, INT, STR = Kind(bool), Kind(float), Kind(int), Kind(str)
# Names of the types in XML and YAML launch files; None means the type of the YAML text.
KINDS: dict[str, Kind | None] = {
    **{kind.__name__: Kind(kind) for kind in SCALARS},
    **{f"list_of_{kind.__name__}": Kind(kind, is_list=True) for kind in SCALARS},
    "yaml": None,
}


@dataclass(frozen=True)
class Parts:
    """Substitutions and texts that make one value; its type is that of the text they give."""

    parts: tuple[Any, ...]


def kind_of(data_type: Any) -> Kind | None:
    """Return the kind that Python code names by a type: `int`, `List[int]`, `list[int]`."""
    if data_type is None or isinstance(data_type, Kind):
        return data_type
    arguments = getattr(data_type, "__args__", None)
    is_list = bool(arguments) and getattr(data_type, "__origin__", None) is list
    scalar = arguments[0] if is_list and arguments else data_type
    if scalar not in SCALARS:
        raise LaunchFileError("bool, int, float, str or a list of one of them", repr(data_type))
    return Kind(scalar, is_list)


def coerce(text: str, kind: Kind | None, *, may_be_text: bool = False) -> Any:
    """Convert a text to a kind; `may_be_text` leaves what may hold substitutions as text."""
    if kind is None:
        return _as_yaml(text, kind, may_be_text)
    if kind == STR:
        return text
    if kind in (INT, FLOAT):
        try:
            return kind.scalar(text)
        except ValueError:
            if may_be_text:
                return text
            raise _not_of(kind, text) from None
    known = {"1": "true", "0": "false"} if kind == BOOL else {}
    value = _as_yaml(known.get(text, text), kind, may_be_text)
    if not is_of_kind(value, kind, may_be_text=may_be_text):
        raise _not_of(kind, text)
    return value


def coerce_list(texts: list[str], kind: Kind | None) -> list[Any]:
    """Convert the texts of an attribute with a separator."""
    if kind is not None and not kind.is_list:
        raise LaunchFileError(f"one value of type {kind}", repr(texts))
    scalar = None if kind is None else Kind(kind.scalar)
    values = [coerce(text, scalar, may_be_text=True) for text in texts]
    if not is_of_kind(values, None, may_be_text=True):
        raise LaunchFileError("a list of values of one type", repr(values))
    return values


def is_of_kind(value: Any, kind: Kind | None, *, may_be_text: bool = False) -> bool:
    """Return whether a value has the kind, or with None, any kind that launch knows."""
    text = (str,) if may_be_text else ()
    if kind is not None:
        is_list, scalars = kind.is_list, (kind.scalar, *text)
    else:
        is_list, scalars = isinstance(value, list), SCALARS
        if isinstance(value, list):
            first = next((type(item) for item in value if type(item) is not str), str)
            scalars = (first, *text)
            if first not in SCALARS:
                return False
    if is_list:
        return isinstance(value, list) and all(isinstance(item, scalars) for item in value)
    return isinstance(value, scalars)


def is_substitution(value: Any) -> bool:
    """Return whether a value is a substitution, or texts and substitutions that make one text."""
    if isinstance(value, Substitution):
        return True
    if not isinstance(value, (list, tuple)):
        return False
    known = all(isinstance(part, (Substitution, str)) for part in value)
    return known and any(isinstance(part, Substitution) for part in value)


def normalise(value: Any, kind: Kind | None) -> Any:
    """Return a scalar, Parts, or a list of both; raise LaunchFileError for other values."""
    if isinstance(value, (*SCALARS, Parts)):
        if isinstance(value, SCALARS) and not is_of_kind(value, kind):
            raise _not_of(kind, value)
        return value
    if is_substitution(value):
        return _parts(value)
    if not isinstance(value, Iterable) or isinstance(value, (bytes, Substitution)):
        raise _not_of(kind, value)
    items = [_item(item, kind) for item in value]
    types = {type(item) for item in items} - {Parts}
    if kind is not None and not kind.is_list:
        raise _not_of(kind, value)
    if items and not types:
        return items
    for scalar in (str, bool, int):
        if types <= {scalar}:
            return _all_of(items, scalar, kind)
    if types <= {int, float}:
        values = [item if isinstance(item, Parts) else float(item) for item in items]
        return _all_of(values, float, kind)
    raise LaunchFileError("a list of values of one type", repr(value))


def perform_typed(context: LaunchContext, value: Any, kind: Kind | None) -> Any:
    """Evaluate a value that is normalised for the same kind."""
    if isinstance(value, Parts):
        return coerce(perform(context, value.parts), kind)
    if not isinstance(value, list):
        return value
    scalar = None if kind is None else Kind(kind.scalar)
    items = [
        coerce(perform(context, item.parts), scalar) if isinstance(item, Parts) else item
        for item in value
    ]
    if not is_of_kind(items, kind):
        raise _not_of(kind, items)
    return items


def boolean(context: LaunchContext, value: Any) -> bool:
    """Evaluate a boolean, as `not`, `and`, `or`, `any`, `all` and options of actions do."""
    return bool(perform_typed(context, normalise(value, BOOL), BOOL))


def truth(context: LaunchContext, operand: Any) -> bool:
    """Evaluate an operand of `not`, `and`, `or`, `any`, `all`: a text that is a boolean."""
    return bool(coerce(perform(context, operand), BOOL))


def from_yaml(text: str) -> Any:
    """Return the value of a text in YAML 1.1; raise LaunchFileError if it has none."""
    try:
        return yaml.safe_load(text)
    except Exception as error:  # impossible numbers and dates, or depth, raise errors of their own
        raise LaunchFileError("a value in YAML", repr(text)) from error


def _as_yaml(text: str, kind: Kind | None, may_be_text: bool) -> Any:
    if not text:
        return text
    try:
        value = from_yaml(text)
    except LaunchFileError:
        if may_be_text:
            return text
        raise
    if not is_of_kind(value, None, may_be_text=may_be_text):
        raise _not_of(kind, text)
    return value


def _item(item: Any, kind: Kind | None) -> Any:
    if isinstance(item, Parts):
        return item
    if is_substitution(item):
        return _parts(item)
    for scalar in (bool, int, float, str):  # not a subclass of the launch file
        if isinstance(item, scalar):
            return scalar(item)
    raise _not_of(kind, item)


def _parts(value: Any) -> Parts:
    return Parts((value,) if isinstance(value, Substitution) else tuple(value))


def _all_of(items: list[Any], scalar: type, kind: Kind | None) -> list[Any]:
    if kind is not None and kind.scalar is not scalar:
        raise _not_of(kind, items)
    return items


def _not_of(kind: Kind | None, found: Any) -> LaunchFileError:
    if kind is None:
        return LaunchFileError("a bool, number, text or list of one of them", repr(found))
    return LaunchFileError(f"a value of type {kind}", repr(found))
