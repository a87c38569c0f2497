# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Optional library that solves."""

from __future__ import annotations

from rmw_manycore_py.errors import ManycoreError


def require_library() -> None:
    """Raise ManycoreError with install instructions if the library is missing."""
    try:
        import ortools.sat.python.cp_model  # noqa: F401
    except ImportError as error:
        raise ManycoreError(
            f"advice needs the library OR-tools ({error}): pip install 'rmw-manycore[advise]'"
        ) from error
