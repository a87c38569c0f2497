# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Which of this user's platforms run."""

from __future__ import annotations

from collections.abc import Iterable

from rmw_manycore_py.native import _transport


def is_alive(name: str) -> bool:
    """Return whether any process uses a platform; one that cannot be read counts as dead."""
    try:
        with _transport.Platform(name) as opened:
            return opened.info().alive
    except _transport.PlatformError:
        return False


def running_text(names: Iterable[str], hint: str = "") -> str:
    """Return which of these platforms run, for errors about one that does not exist.

    :param hint: follows their names.
    """
    alive = [name for name in names if is_alive(name)]
    return f"there is {', '.join(alive)}{hint}" if alive else "none is running"
