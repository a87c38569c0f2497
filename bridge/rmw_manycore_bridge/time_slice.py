# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A short time slice for the bridge, so that subscribers beside it empty their sockets in time.

A large message leaves as a burst of datagrams, and a socket buffer of the default size holds only
a few of them. Linux lets a running thread use up its slice before a thread that wakes replaces it;
within a slice of milliseconds the whole burst is sent, and most of it dropped. Linux 6.12 and later
let a thread ask for a slice of its own; earlier ones ignore the wish.
"""

from __future__ import annotations

import ctypes
import os
import struct

SLICE_NS = 100_000  # the shortest that Linux grants

_SYS_SCHED_SETATTR, _SYS_SCHED_GETATTR = 314, 315  # of x86-64
# struct sched_attr of sched_setattr(2), version 0: size, policy, flags, nice, priority,
# runtime, deadline, period. For SCHED_OTHER the runtime is the slice.
_ATTRIBUTES = struct.Struct("IIQiIQQQ")
_libc = ctypes.CDLL(None, use_errno=True)


def shorten_time_slice() -> bool:
    """Shorten the slice of the calling thread and of all that it starts; False if Linux refuses.

    A thread under another policy than SCHED_OTHER has no slice, and stays as it is.
    """
    if os.sched_getscheduler(0) != os.SCHED_OTHER:
        return False
    nice = os.getpriority(os.PRIO_PROCESS, 0)
    wanted = _ATTRIBUTES.pack(_ATTRIBUTES.size, os.SCHED_OTHER, 0, nice, 0, SLICE_NS, 0, 0)
    return bool(_libc.syscall(_SYS_SCHED_SETATTR, 0, wanted, 0) == 0)


def time_slice_ns(thread: int = 0) -> int:
    """Return the slice of a thread, 0 where this kernel does not tell."""
    found = ctypes.create_string_buffer(_ATTRIBUTES.size)
    if _libc.syscall(_SYS_SCHED_GETATTR, thread, found, _ATTRIBUTES.size, 0) != 0:
        return 0
    return int(_ATTRIBUTES.unpack(found.raw)[5])
