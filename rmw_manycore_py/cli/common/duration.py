# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The option `--duration`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from rmw_manycore_py.cli.common.seconds import Seconds


def duration_option(
    default_s: float | None = None,
    text: str = "Stop this long after the start of the last node (seconds, or as 90s, 5m).",
    *,
    endless: bool = True,
) -> Callable[[Any], Any]:
    """Return the option `--duration`, in seconds; with `endless` also inf."""
    return click.option(
        "--duration",
        "duration_s",
        type=Seconds(endless=endless),
        metavar="S",
        default=default_s,
        show_default=default_s is not None,
        help=text,
    )
