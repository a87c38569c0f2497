# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Exceptions that file readers raise for damaged files, whose headers they trust; in our words."""

from __future__ import annotations

import lzma
import struct
import tokenize
import zipfile
import zlib

UNREADABLE = (
    OSError,
    ValueError,
    TypeError,
    LookupError,
    EOFError,
    RuntimeError,  # also unknown compression, or a password, of zip files
    ArithmeticError,  # size beyond 64 bits
    MemoryError,  # size beyond available memory
    struct.error,
    tokenize.TokenError,
    zipfile.BadZipFile,
    zlib.error,
    lzma.LZMAError,
)
DAMAGED = "it is damaged or cut short"


def why_unreadable(error: Exception) -> str:
    """Return the fault of a file, in its own terms.

    The messages of this package's own readers (ValueError) are kept, those of libraries are not.
    """
    if isinstance(error, MemoryError):
        return "it announces more data than memory can hold"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return str(error) if type(error) is ValueError else DAMAGED


def why_no_arrays(error: Exception) -> str:
    """Return why numpy cannot load a file of arrays."""
    if type(error) is not ValueError:
        return why_unreadable(error)
    return "it holds Python objects, not numbers" if "Object arrays" in str(error) else DAMAGED
