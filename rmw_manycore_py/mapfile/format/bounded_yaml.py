# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bounded YAML loader: no input exhausts memory or time."""

from __future__ import annotations

from typing import Any

import yaml

from rmw_manycore_py.errors import shorten

# A mapfile of 1024 nodes takes about 300 KiB and 40,000 values.
MAX_BYTES = 1 << 20
MAX_DEPTH = 50
MAX_VALUES = 100_000
# A scalar counts as one more value per this many characters, since aliases repeat it.
_CHARACTERS_OF_A_VALUE = 100
_MAX_SHOWN = 60
# Longer than any 64-bit number or date.
_MAX_NUMBER_CHARACTERS = 400
_MIN_INTEGER, _MAX_INTEGER = -(1 << 63), (1 << 64) - 1
_NUMBERS = {"int": "an integer of at most 64 bits", "float": "a number", "timestamp": "a date"}
_SCALARS = {**_NUMBERS, "bool": "true or false", "binary": "base64"}


class BoundError(yaml.MarkedYAMLError):
    """YAML that exceeds a bound, although its syntax may be valid."""

    def __init__(self, expected: str, found: str, mark: yaml.Mark) -> None:
        super().__init__(problem=found, problem_mark=mark)
        self.expected = expected


class BoundedLoader(yaml.SafeLoader):
    """Composes nodes; counts each alias with its expanded size before anything expands it."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self._values = 0
        self._depth = 0
        self._deepest = 0
        self._anchored: dict[str, tuple[int, int]] = {}

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        """Compose a node; record its number of values and its depth."""
        event: Any = self.peek_event()  # type: ignore[no-untyped-call]
        outer, before = self._deepest, self._values
        self._depth += 1
        self._deepest = self._depth
        self._check(event)
        node = super().compose_node(parent, index)
        # An alias inside its own anchor is still open; it is rejected later.
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
        """Return the value of a scalar; raise BoundError if its text does not match its tag."""
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

    def is_untyped(self, node: yaml.ScalarNode) -> bool:
        """Return whether a scalar has neither quotes nor a tag."""
        resolver: Any = self  # untyped
        tag = resolver.resolve(yaml.ScalarNode, node.value, (True, False))
        return node.style is None and node.tag == tag

    def _check(self, event: Any) -> None:
        if self._deepest > MAX_DEPTH:
            expected = f"at most {MAX_DEPTH} levels of nesting"
            raise BoundError(expected, "more", event.start_mark)
        if self._values > MAX_VALUES:
            expected = f"at most {MAX_VALUES} values, each alias counted as what it stands for"
            raise BoundError(expected, "more", event.start_mark)


def _check_text(text: str, node: yaml.Node) -> None:
    if "\0" in text:
        raise BoundError("text without NUL characters", f"'{text}'", node.start_mark)
    if not text.isascii() and any("\ud800" <= char <= "\udfff" for char in text):
        raise BoundError("text without halves of surrogate pairs", f"'{text}'", node.start_mark)
