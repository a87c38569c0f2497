# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Key sequences that detach from a node's terminal, in docker's notation."""

from __future__ import annotations

_CTRL = "ctrl-"
# Control characters besides the letters, as written after "ctrl-".
_OTHERS = {"@": 0, "[": 27, "\\": 28, "]": 29, "^": 30, "_": 31}


def parse_keys(text: str) -> bytes:
    """Return the bytes that a terminal sends for keys such as ctrl-p,ctrl-q.

    :raises ValueError: for an unknown key.
    """
    return bytes(_key(part.strip()) for part in text.split(","))


def _key(name: str) -> int:
    if name.startswith(_CTRL) and len(name) == len(_CTRL) + 1:
        letter = name[-1].lower()
        if "a" <= letter <= "z":
            return ord(letter) - ord("a") + 1
        if letter in _OTHERS:
            return _OTHERS[letter]
    if len(name) == 1 and name.isascii() and name.isprintable():
        return ord(name)
    raise ValueError(f"expected keys such as ctrl-p,ctrl-q, found '{name}'")


class DetachKeys:
    """Detects the detach sequence in the input; holds a partial match back until it is decided."""

    def __init__(self, keys: bytes) -> None:
        self._keys = keys
        self._held = 0

    def take(self, data: bytes) -> tuple[bytes, bool]:
        """Return the bytes to forward to the node, and whether the sequence is complete."""
        passed = bytearray()
        for key in data:
            if key == self._keys[self._held]:
                self._held += 1
                if self._held == len(self._keys):
                    self._held = 0
                    return bytes(passed), True
                continue
            passed += self._keys[: self._held]
            self._held = 0
            if key == self._keys[0]:
                self._held = 1
                if len(self._keys) == 1:
                    return bytes(passed), True
            else:
                passed.append(key)
        return bytes(passed), False
