# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Keys of a player on a terminal, as in `ros2 bag play`."""

from __future__ import annotations

from collections.abc import Iterator

from rmw_manycore_py.recording.play.position import Position

HELP = "space: pause; right: next message; up, down: faster, slower; Ctrl-C: end"
_ARROWS = {"A": "up", "B": "down", "C": "right"}


def press(position: Position, typed: str) -> None:
    """Apply keys; ignore unknown ones."""
    for key in _keys(typed):
        if key == " ":
            position.toggle_pause()
        elif key == "right":
            position.step()
        elif key == "up":
            position.faster()
        elif key == "down":
            position.slower()


def _keys(typed: str) -> Iterator[str]:
    """Yield keys; a terminal sends an arrow as ESC [ letter or ESC O letter."""
    rest = typed
    while rest:
        if rest[:2] in ("\x1b[", "\x1bO"):
            yield _ARROWS.get(rest[2:3], "")
            rest = rest[3:]
        else:
            yield rest[0]
            rest = rest[1:]
