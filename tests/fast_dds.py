# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What processes on Fast DDS that were killed leave to all others of this machine."""

from __future__ import annotations

import sys
import time
from pathlib import Path

SHARED_MEMORY = Path("/dev/shm")
_FINISHED = 2  # the first word of what boost's interprocess library has made and filled in
_MAKING_S = 0.2  # far above what a process takes that lives


def remove_unfinished_ports() -> None:
    """Remove ports of Fast DDS whose maker was killed meanwhile.

    Each process that comes to use such a port waits for ever that it be finished, and one of them
    is used by all.
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
            return int.from_bytes(file.read(4), sys.byteorder)  # 0 where it has no size yet
    except FileNotFoundError:
        return _FINISHED
