# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Processes beyond their pids, which are reused, and which each PID namespace has of its own."""

from __future__ import annotations

import functools
import os
from pathlib import Path
from typing import NamedTuple

_NAMESPACE = "/proc/self/ns/pid"
_PF_EXITING = 0x4  # <linux/sched.h>; set before the kernel closes what a process has open


class ProcessIdentity(NamedTuple):
    """A process of this user.

    :ivar namespace: inode of its PID namespace.
    :ivar start: when it started, in clock ticks since boot (proc(5), starttime).
    """

    namespace: int
    pid: int
    start: int


def own_identity() -> ProcessIdentity:
    """Return the identity of this process, also in a child of fork()."""
    return _identity(os.getpid())


def has_ended(process: ProcessIdentity) -> bool:
    """Return whether a process has ended, or is ending; False for those of other PID namespaces."""
    if process.namespace != os.stat(_NAMESPACE).st_ino:
        return False
    try:
        flags, start = _flags_and_start(process.pid)
    except (FileNotFoundError, ProcessLookupError):
        return True
    except PermissionError:  # /proc hides processes of other users
        return False
    return bool(flags & _PF_EXITING) or start != process.start


@functools.lru_cache(maxsize=1)
def _identity(pid: int) -> ProcessIdentity:
    return ProcessIdentity(os.stat(_NAMESPACE).st_ino, pid, _flags_and_start(pid)[1])


def _flags_and_start(pid: int) -> tuple[int, int]:
    """Return fields 9 and 22; the second field, a name in brackets, may have spaces."""
    fields = Path(f"/proc/{pid}/stat").read_bytes().rpartition(b")")[2].split()
    return int(fields[6]), int(fields[19])
