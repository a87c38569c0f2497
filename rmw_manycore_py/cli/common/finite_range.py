# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Numbers on the command line, within bounds."""

from __future__ import annotations

from typing import Any

import click
from typing_extensions import override

_MAX_NUMBER = 4e9  # seconds from now that are a time in nanoseconds of 63 bits
MIN_RATE = 1e-9  # per second; its period is such a number, too
MAX_DEPTH = 1 << 20  # of a queue
_MAX_WHOLE = (1 << 63) - 1


class FiniteRange(click.FloatRange):
    """A range of finite numbers that may be seconds."""

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


class WholeRange(click.IntRange):
    """A range of whole numbers of 63 bits."""

    def convert(
        self, value: Any, param: click.Parameter | None, context: click.Context | None
    ) -> int:
        """Return the number, or fail with a usage error."""
        number = int(super().convert(value, param, context))
        if abs(number) > _MAX_WHOLE:
            self.fail(f"expected a number up to {_MAX_WHOLE}, found {value}.", param, context)
        return number
