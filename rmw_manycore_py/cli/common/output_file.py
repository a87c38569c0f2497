# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Output files of commands, validated before the work starts."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.errors import ManycoreError


class OutputFile(click.Path):
    """A file in an existing directory, with one of the given suffixes if there are any."""

    def __init__(self, *suffixes: str) -> None:
        super().__init__(dir_okay=False, writable=True, path_type=Path)
        self._suffixes = suffixes

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the path, or fail with a usage error."""
        path = super().convert(value, param, ctx)
        assert isinstance(path, Path)
        if self._suffixes and path.suffix not in self._suffixes:
            self.fail(f"'{path}': expected a file that ends in {', '.join(self._suffixes)}")
        if not path.parent.is_dir():
            self.fail(f"'{path}': there is no directory '{path.parent}'")
        return path


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Convert an OSError while writing `path` into a ManycoreError."""
    try:
        yield
    except OSError as error:
        raise ManycoreError(f"{path}: cannot be written: {error.strerror or error}") from error
