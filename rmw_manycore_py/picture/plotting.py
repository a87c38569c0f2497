# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Optional plotting with matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmw_manycore_py.errors import ManycoreError

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def load_figure() -> type[Figure]:
    """Return matplotlib's Figure class, which needs no display.

    Call it before a long run that ends with a plot.

    :raises ManycoreError: if matplotlib is not installed; the text has the command to install it.
    """
    try:
        from matplotlib import figure
    except ImportError as error:
        raise ManycoreError(
            f"matplotlib cannot be loaded ({error}). Plots need it: "
            "pip install 'rmw-manycore[bench]', or [ndt], or [trace]"
        ) from error
    figure_class: type[Figure] = figure.Figure  # unknown to type checkers without matplotlib
    return figure_class
