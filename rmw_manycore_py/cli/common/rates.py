# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Traces that are read for their rates."""

from __future__ import annotations

from pathlib import Path

from rmw_manycore_py.cli.common.printing import counted, print_notices
from rmw_manycore_py.trace.events import Trace
from rmw_manycore_py.trace.files import load


def load_rates(path: Path) -> Trace:
    """Read a trace, with a notice if it lacks events."""
    trace = load(path)
    if trace.lost:
        lost = counted(trace.lost, "event")
        print_notices([f"{path} lacks {lost}, so rates are too low: use trace start --events N"])
    return trace
