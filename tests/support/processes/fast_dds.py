# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What killed processes on Fast DDS leave to the others of this machine."""

from __future__ import annotations

import sys
import time
from pathlib import Path

SHARED_MEMORY = Path("/dev/shm")
_FINISHED = 2  # first word of an initialised segment of Boost.Interprocess
_MAKING_S = 0.2  # far above what a living process needs


def remove_unfinished_ports() -> None:
    """Remove ports of Fast DDS whose creator was killed before it had initialised them.

    Each process that opens such a port waits for its initialisation forever, and all processes
    open one of them.
    """
    before = _unfinished()
    if before:
        time.sleep(_MAKING_S)
        for path in before & _unfinished():
            path.unlink(missing_ok=True)


def _unfinished() -> set[Path]:
    ports = SHARED_MEMORY.glob("fastrtps_port*[0-9]")
    return {port for port in ports if _state_of(port) < _FINISHED}


def _state_of(path: Path) -> int:
    try:
        with path.open("rb") as file:
            return int.from_bytes(file.read(4), sys.byteorder)  # 0 before it was resized
    except FileNotFoundError:
        return _FINISHED
