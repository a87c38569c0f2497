# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Translates errors of the native modules to ManycoreError."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rmw_manycore_py.errors import EXIT_FAILURE, ManycoreError, what_is_wrong
from rmw_manycore_py.native import _ndt, _transport


@contextmanager
def translate_native_errors(subject: str = "", exit_status: int = EXIT_FAILURE) -> Iterator[None]:
    """Translate errors of `_transport` and `_ndt`, and memory exhaustion, to ManycoreError.

    :param subject: what failed; starts the message.
    """
    try:
        yield
    except (_transport.PlatformError, _ndt.NdtError, MemoryError) as error:
        text = what_is_wrong(error)
        raise ManycoreError(f"{subject}: {text}" if subject else text, exit_status) from error
