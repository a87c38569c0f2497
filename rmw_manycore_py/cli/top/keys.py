# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Key bindings of `manycore top`."""

from __future__ import annotations

from dataclasses import replace

from rmw_manycore_py.cli.top.rows import NODE_ORDERS, TOPIC_ORDERS
from rmw_manycore_py.cli.top.screen import Choices

ESCAPE, ENTER, ERASE = "\x1b", "\r\n", "\x7f\b"


def after_keys(choices: Choices, keys: str) -> Choices | None:
    """Return the choices after these keys; None to quit."""
    if keys.startswith(ESCAPE) and len(keys) > 1:
        return choices  # arrow or function key
    for key in keys:
        after = _typed(choices, key) if choices.is_typing else _command(choices, key)
        if after is None:
            return None
        choices = after
    return choices


def _typed(choices: Choices, key: str) -> Choices:
    if key in ENTER:
        return replace(choices, is_typing=False)
    if key == ESCAPE:
        return replace(choices, is_typing=False, pattern="")
    if key in ERASE:
        return replace(choices, pattern=choices.pattern[:-1])
    return replace(choices, pattern=choices.pattern + key) if key.isprintable() else choices


def _command(choices: Choices, key: str) -> Choices | None:
    if key in ("q", "Q"):
        return None
    if key == "n":
        return replace(choices, node_order=_next(list(NODE_ORDERS), choices.node_order))
    if key == "t":
        return replace(choices, topic_order=_next(list(TOPIC_ORDERS), choices.topic_order))
    if key == "r":
        return replace(choices, reverse=not choices.reverse)
    if key == "/":
        return replace(choices, is_typing=True)
    if key == ESCAPE:
        return replace(choices, pattern="")
    return choices


def _next(orders: list[str], order: str) -> str:
    return orders[(orders.index(order) + 1) % len(orders)]
