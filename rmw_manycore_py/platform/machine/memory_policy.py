# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Whether the kernel lets this process choose NUMA nodes for memory (mbind(2))."""

from __future__ import annotations

import ctypes
import mmap
import os
import platform

_SYS_MBIND = {"x86_64": 237, "aarch64": 235}
_MPOL_DEFAULT = 0


def policy_refusal() -> str:
    """Return why memory cannot be bound to NUMA nodes here; empty if it can.

    Kernels without NUMA and containers without CAP_SYS_NICE refuse it.
    """
    number = _SYS_MBIND.get(platform.machine())
    if number is None:
        return f"not known on {platform.machine()}"
    with mmap.mmap(-1, mmap.PAGESIZE) as page:
        word = ctypes.c_char.from_buffer(page)
        address, size = ctypes.c_void_p(ctypes.addressof(word)), ctypes.c_size_t(mmap.PAGESIZE)
        library = ctypes.CDLL(None, use_errno=True)
        result = library.syscall(number, address, size, _MPOL_DEFAULT, None, 0, 0)
        del word
    return "" if result == 0 else os.strerror(ctypes.get_errno())
