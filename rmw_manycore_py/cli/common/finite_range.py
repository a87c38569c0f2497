# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A number on the command line, within bounds."""

from __future__ import annotations

from typing import Any

import click
from typing_extensions import override

_MAX_NUMBER = 1e12


class FiniteRange(click.FloatRange):
    """A range of finite numbers whose value in nanoseconds fits."""

    def convert(
        self, value: Any, param: click.Parameter | None, context: click.Context | None
    ) -> float:
        """Return the number, or fail with a usage error."""
        number = float(super().convert(value, param, context))
        if not abs(number) <= _MAX_NUMBER:
            self.fail(f"expected a number up to {_MAX_NUMBER:g}, found {value}.", param, context)
        return number

    @override
    def _describe_range(self) -> str:
        return "" if self.min is self.max is None else super()._describe_range()
