# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Exceptions that file readers raise for damaged files, whose headers they trust."""

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
