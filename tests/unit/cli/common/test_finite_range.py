# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What `--help` says about the bounds of a number."""

from __future__ import annotations

import click
import pytest

from rmw_manycore_py.cli.common.finite_range import FiniteRange

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(
    ("number_range", "text"),
    [
        (FiniteRange(), "--time S  Seconds."),
        (FiniteRange(min=1), "--time S  Seconds.  [x>=1]"),
        (FiniteRange(min=0, min_open=True), "--time S  Seconds.  [x>0]"),
        (FiniteRange(0, 2), "--time S  Seconds.  [0<=x<=2]"),
    ],
)
def test_help_states_only_bounds_that_there_are(number_range: FiniteRange, text: str) -> None:
    option = click.Option(["--time"], type=number_range, metavar="S", help="Seconds.")
    record = option.get_help_record(click.Context(click.Command("verb")))
    assert record is not None
    assert "  ".join(record) == text
