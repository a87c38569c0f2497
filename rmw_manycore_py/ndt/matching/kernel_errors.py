# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Failures of the kernel, as errors that callers know."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rmw_manycore_py import _ndt
from rmw_manycore_py.errors import ManycoreError, what_is_wrong


@contextmanager
def reported() -> Iterator[None]:
    """Raise a ManycoreError where workers die again and again, or memory is at an end."""
    try:
        yield
    except (_ndt.NdtError, MemoryError) as error:
        raise ManycoreError(f"the matcher cannot work: {what_is_wrong(error)}") from error
