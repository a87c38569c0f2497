# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""YAML within bounds: no file, however it is made, takes the reader all memory or all day."""

from __future__ import annotations

import re
from typing import Any

import yaml

from rmw_manycore_py.errors import shorten

# A mapfile of 1024 nodes takes about 300 KiB and 40,000 values.
MAX_BYTES = 1 << 20
MAX_DEPTH = 50
MAX_VALUES = 100_000
# A text of so many characters counts as one more value: an alias repeats it, too.
_CHARACTERS_OF_A_VALUE = 100
_MAX_SHOWN = 60
# More characters than any number of 64 bits or date needs.
_MAX_NUMBER_CHARACTERS = 400
_MIN_INTEGER, _MAX_INTEGER = -(1 << 63), (1 << 64) - 1
_NUMBERS = {"int": "an integer of at most 64 bits", "float": "a number", "timestamp": "a date"}
_SCALARS = {**_NUMBERS, "bool": "true or false", "binary": "base64"}


class BoundError(yaml.MarkedYAMLError):
    """YAML that is refused although its syntax may be right."""

    def __init__(self, expected: str, found: str, mark: yaml.Mark) -> None:
        super().__init__(problem=found, problem_mark=mark)
        self.expected = expected


class BoundedLoader(yaml.SafeLoader):
    """Composes nodes; counts each alias as what it stands for, before anything expands it."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self._values = 0
        self._depth = 0
        self._deepest = 0
        self._anchored: dict[str, tuple[int, int]] = {}

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        """Compose a node and note how many values it holds, and how deep they are."""
        event: Any = self.peek_event()  # type: ignore[no-untyped-call]
        outer, before = self._deepest, self._values
        self._depth += 1
        self._deepest = self._depth
        self._check(event)
        node = super().compose_node(parent, index)
        # The node of an alias inside of itself is still open, and refused later.
        aliased = isinstance(event, yaml.AliasEvent)
        values, height = self._anchored.get(event.anchor, (1, 0)) if aliased else (1, 0)
        self._values += values + len(getattr(event, "value", "")) // _CHARACTERS_OF_A_VALUE
        self._deepest = max(self._deepest, self._depth + height)
        self._check(event)
        if event.anchor and not aliased:
            self._anchored[event.anchor] = self._values - before, self._deepest - self._depth
        self._depth -= 1
        self._deepest = max(outer, self._deepest)
        return node

    def scalar(self, node: yaml.Node) -> Any:
        """Return the value of a scalar; text that its tag does not allow is a BoundError."""
        kind = node.tag.rpartition(":")[2]
        try:
            if kind in _NUMBERS and len(node.value) > _MAX_NUMBER_CHARACTERS:
                raise ValueError
            value = self.construct_object(node, deep=True)
            if isinstance(value, int) and not _MIN_INTEGER <= value <= _MAX_INTEGER:
                raise ValueError
        except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
            expected = _SCALARS.get(kind, "a value of its tag")
            found = f"'{shorten(node.value, _MAX_SHOWN)}'"
            raise BoundError(expected, found, node.start_mark) from error
        if isinstance(value, str):
            _check_text(value, node)
        return value

    def _check(self, event: Any) -> None:
        if self._deepest > MAX_DEPTH:
            expected = f"at most {MAX_DEPTH} levels of nesting"
            raise BoundError(expected, "more", event.start_mark)
        if self._values > MAX_VALUES:
            expected = f"at most {MAX_VALUES} values, each alias counted as what it stands for"
            raise BoundError(expected, "more", event.start_mark)


# As rcl reads numbers, where YAML 1.1 wants a point and a sign: 1e-9.
_EXPONENT = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)[eE][-+]?\d+$")
BoundedLoader.add_implicit_resolver("tag:yaml.org,2002:float", _EXPONENT, list("-+.0123456789"))


def is_number_to_rcl(text: str) -> bool:
    """Tell whether a text is a number to rcl, and none to YAML 1.1."""
    return _EXPONENT.match(text) is not None


def _check_text(text: str, node: yaml.Node) -> None:
    if "\0" in text:
        raise BoundError("text without NUL characters", f"'{text}'", node.start_mark)
    if not text.isascii() and any("\ud800" <= char <= "\udfff" for char in text):
        raise BoundError("text without halves of surrogate pairs", f"'{text}'", node.start_mark)
