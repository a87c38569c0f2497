# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Short scheduler time slice for the bridge, so that co-located subscribers drain their sockets.

A large message is sent as a burst of datagrams, and a default socket buffer holds only a few of
them. Linux lets a running thread use up its slice before a woken thread preempts it; within a slice
of milliseconds the whole burst is sent and most of it dropped. Linux 6.12 and later let a thread
request a slice; earlier kernels ignore the request.
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
    """Shorten the slice of the calling thread and of threads it starts; False if Linux refuses.

    Threads of policies other than SCHED_OTHER have no slice and are left unchanged.
    """
    if os.sched_getscheduler(0) != os.SCHED_OTHER:
        return False
    nice = os.getpriority(os.PRIO_PROCESS, 0)
    wanted = _ATTRIBUTES.pack(_ATTRIBUTES.size, os.SCHED_OTHER, 0, nice, 0, SLICE_NS, 0, 0)
    return bool(_libc.syscall(_SYS_SCHED_SETATTR, 0, wanted, 0) == 0)


def time_slice_ns(thread: int = 0) -> int:
    """Return the slice of a thread in ns; 0 if the kernel does not report it."""
    found = ctypes.create_string_buffer(_ATTRIBUTES.size)
    if _libc.syscall(_SYS_SCHED_GETATTR, thread, found, _ATTRIBUTES.size, 0) != 0:
        return 0
    return int(_ATTRIBUTES.unpack(found.raw)[5])
