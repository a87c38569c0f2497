# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Lengths of time on the command line."""

from __future__ import annotations

import click
import pytest

from rmw_manycore_py.cli.common.seconds import Seconds

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        *(("90", 90.0), ("0.5", 0.5), ("90s", 90.0), ("5m", 300.0), ("1h30m", 5400.0)),
        *(("250ms", 0.25), ("1m0.5s", 60.5), ("1e3", 1000.0), ("inf", float("inf"))),
    ],
)
def test_units_are_added_up(text: str, seconds: float) -> None:
    assert Seconds().convert(text, None, None) == pytest.approx(seconds)


@pytest.mark.parametrize("text", ["", "0", "0s", "-1", "5x", "m", "5m3", "nan", "-inf", "1e13"])
def test_anything_else_is_a_usage_error(text: str) -> None:
    with pytest.raises(click.BadParameter):
        Seconds().convert(text, None, None)


def test_an_unknown_unit_is_answered_with_those_that_are_known() -> None:
    with pytest.raises(click.BadParameter, match=r"as in 90s, 5m, 1h30m; found '5x'"):
        Seconds().convert("5x", None, None)


@pytest.mark.parametrize("value", ["inf", float("inf")])
def test_what_has_to_end_refuses_infinity(value: object) -> None:
    with pytest.raises(click.BadParameter, match="expected seconds that end, found inf"):
        Seconds(endless=False).convert(value, None, None)
