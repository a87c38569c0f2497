# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Keys, order and layout of `manycore top`."""

from __future__ import annotations

import pytest
from rich.console import Console

from rmw_manycore_py.cli.top.keys import after_keys
from rmw_manycore_py.cli.top.rows import ordered
from rmw_manycore_py.cli.top.screen import Choices, bar

pytestmark = pytest.mark.unit


def test_keys_choose_orders() -> None:
    choices = after_keys(Choices(), "ntr")
    assert choices == Choices(node_order="cluster", topic_order="queue", reverse=True)
    assert after_keys(Choices(), "nnnn") == Choices()
    assert after_keys(Choices(), "nq") is None
    assert after_keys(Choices(), "\x1b[A") == Choices(), "an arrow is no escape"


def test_a_filter_is_typed() -> None:
    typing = after_keys(Choices(), "/qn\x7ft")
    assert typing == Choices(pattern="qt", is_typing=True)
    assert after_keys(typing, "\r") == Choices(pattern="qt")
    assert after_keys(typing, "\x1b") == Choices()
    assert after_keys(Choices(pattern="x"), "\x1b") == Choices()


def test_rows_are_ordered() -> None:
    rows = [{"p99_us": None, "node": "b"}, {"p99_us": 1, "node": "c"}, {"p99_us": 2, "node": "a"}]
    assert [row["p99_us"] for row in ordered(rows, "p99_us")] == [2, 1, None]
    assert [row["p99_us"] for row in ordered(rows, "p99_us", reverse=True)] == [1, 2, None]
    assert [row["node"] for row in ordered(rows, "node")] == ["a", "b", "c"]


@pytest.mark.parametrize(("percent", "filled"), [(0, 0), (1, 1), (50, 5), (100, 10), (250, 10)])
def test_bars_are_as_long_as_full(percent: float, filled: int) -> None:
    console = Console(width=20)
    with console.capture() as capture:
        console.print(bar(percent, 10))
    assert capture.get().rstrip() == "█" * filled + "·" * (10 - filled)
