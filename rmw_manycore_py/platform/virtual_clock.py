# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The time of a platform's nodes, for tools beside a run: they look, and take no part in it."""

from __future__ import annotations

import mmap
import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rmw_manycore_py.native import _transport

_FILE = "virtual_time"  # in the platform's directory: the path of the timekeeper's page
_NOW = struct.Struct("q")


@contextmanager
def announced(platform: str, page: str) -> Iterator[None]:
    """Let tools find the time of a platform that exists."""
    file = Path(_transport.platform_directory(platform), _FILE)
    file.write_text(page)
    try:
        yield
    finally:
        file.unlink(missing_ok=True)


def virtual_clock(platform: str) -> Callable[[], int] | None:
    """Return a function that reads the virtual time of a platform [ns]; None in wall time.

    It stands at the last time once the run is over.
    """
    try:
        page = Path(_transport.platform_directory(platform), _FILE).read_text()
        with Path(page).open("rb") as file:
            memory = mmap.mmap(file.fileno(), mmap.PAGESIZE, prot=mmap.PROT_READ)
    except (OSError, RuntimeError, ValueError):  # or what a killed run has left
        return None
    return lambda: int(_NOW.unpack_from(memory, _transport.virtual_now_offset)[0])


def passed_s(clock: Callable[[], int] | None) -> float | None:
    """Return the seconds that have passed in virtual time."""
    return None if clock is None else (clock() - _transport.virtual_start_ns) / 1e9
