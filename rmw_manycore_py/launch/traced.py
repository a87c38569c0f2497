# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Trace of a whole run."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.errors import translate_native_errors

_USUAL = 0  # default events per thread


@contextmanager
def traced(platform: str, path: Path, notice: Callable[[str], None]) -> Iterator[None]:
    """Trace a platform during the block, then save the trace before the platform is removed.

    :raises ManycoreError: if it could only be saved in the directory of temporary files.
    """
    # Loaded when needed: few runs are traced, and all would wait for numpy.
    from rmw_manycore_py.trace.files import save
    from rmw_manycore_py.trace.recorded import recorded

    with translate_native_errors():
        _transport.start_trace(platform, clusters=(), nodes=(), events=_USUAL, discard=False)
    yield
    with recorded(platform) as trace:
        try:
            save(trace, path)
        except ManycoreError as error:
            other = Path(tempfile.mkdtemp(prefix="manycore_"), path.name)
            save(trace, other)
            raise ManycoreError(f"{error}; the trace is in {other}") from error
    lost = f", {trace.lost} lost because rings were full" if trace.lost else ""
    notice(f"trace {path}: {trace.event_count} events{lost}")
