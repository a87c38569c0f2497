# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Files that appear whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError


def require_writable(path: Path) -> None:
    """Raise ManycoreError if `atomic_write` could not open this file: before a long run."""
    try:
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix=f".{path.name}."):
            pass
    except OSError as error:
        raise ManycoreError(
            f"{path}: cannot be written: {error.strerror or error}", EXIT_BAD_INPUT
        ) from error


@contextmanager
def atomic_write(path: Path) -> Iterator[BinaryIO]:
    """Open a file that replaces `path` if the block ends without an error.

    Only its owner may read it, unless the block changes that.
    """
    descriptor, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    written = Path(name)
    try:
        with open(descriptor, "wb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        written.replace(path)
    finally:
        written.unlink(missing_ok=True)
