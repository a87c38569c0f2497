# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A length of time on the command line."""

from __future__ import annotations

import math
import re
from typing import Any

import click

from rmw_manycore_py.cli.common.finite_range import FiniteRange

_PART = re.compile(r"(\d+(?:\.\d*)?|\.\d+)(ms|s|m|h)")
_UNIT_S = {"ms": 0.001, "s": 1.0, "m": 60.0, "h": 3600.0}


class Seconds(FiniteRange):
    """A positive number of seconds, or numbers with units, as in 90s, 5m, 1h30m; inf: no end.

    :param endless: whether inf is accepted.
    """

    name = "seconds"

    def __init__(self, *, endless: bool = True) -> None:
        super().__init__(min=0, min_open=True)
        self._endless = endless

    def convert(
        self, value: Any, param: click.Parameter | None, context: click.Context | None
    ) -> float:
        """Return the seconds, or fail with a usage error."""
        if value in ("inf", math.inf):
            if not self._endless:
                self.fail("expected seconds that end, found inf", param, context)
            return math.inf
        parts = _PART.findall(value) if isinstance(value, str) else []
        if parts and "".join(map("".join, parts)) == value:
            value = sum(float(number) * _UNIT_S[unit] for number, unit in parts)
        try:
            seconds = float(value)
        except ValueError:
            self.fail(f"expected seconds, or units as in 90s, 5m, 1h30m; found {value!r}")
        return super().convert(seconds, param, context)
