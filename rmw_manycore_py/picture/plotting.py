# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Optional plotting with matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmw_manycore_py.errors.missing_library import MATPLOTLIB, require

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def load_figure() -> type[Figure]:
    """Return matplotlib's Figure class, which needs no display.

    Call it before a long run that ends with a plot.

    :raises ManycoreError: if matplotlib is not installed; the text has the command to install it.
    """
    figure_class: type[Figure] = require(MATPLOTLIB).Figure
    return figure_class
