# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The option `--duration`."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import click


def duration_option(
    default_s: float | None = None,
    text: str = "Stop after this many seconds, counted from the start of the last node.",
) -> Callable[[Any], Any]:
    """Return the option `--duration`, in seconds."""
    return click.option(
        "--duration",
        "duration_s",
        type=click.FloatRange(min=0, min_open=True),
        metavar="S",
        default=default_s,
        show_default=default_s is not None,
        callback=_number,
        help=text,
    )


def _number(_context: click.Context, _option: click.Parameter, value: float | None) -> float | None:
    if value is not None and math.isnan(value):
        raise click.BadParameter("nan is not a number of seconds.")
    return value
