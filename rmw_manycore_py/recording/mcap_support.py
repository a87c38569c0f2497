# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Optional library for MCAP."""

from __future__ import annotations

from rmw_manycore_py.errors import ManycoreError


def require_library() -> None:
    """Raise ManycoreError with install instructions if the library is missing."""
    try:
        import mcap.writer  # noqa: F401
    except ImportError as error:
        raise ManycoreError(
            f"recordings need the library mcap ({error}): pip install 'rmw-manycore[record]'"
        ) from error
