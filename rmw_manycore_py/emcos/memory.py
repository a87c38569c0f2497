# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Memory that two processes share, made by POSIX shm_open.

The name of a segment is unlinked as soon as its descriptor is open here; the other side opens it by
the descriptor, which travels over the link. So the kernel frees the memory with the last process
that uses it. A name is left only by a process that is killed between the two system calls: its
peer removes it, or the next process that opens a transfer.
"""

from __future__ import annotations

import errno
import itertools
import mmap
import os
import re
from contextlib import suppress
from pathlib import Path

import numpy as np
import posix_ipc
from numpy.typing import NDArray

from rmw_manycore_py.emcos.process_identity import ProcessIdentity, has_ended, own_identity
from rmw_manycore_py.transport.errors import TransportError

Bytes = NDArray[np.uint8]

_DIRECTORY = Path("/dev/shm")
_NAME = re.compile(r"manycore-emcos-(\d+)\.(\d+)\.(\d+)\.(\d+)\.\d+", re.ASCII)

_numbers = itertools.count()


def create_memory(size_bytes: int, subject: str) -> int:
    """Return the descriptor of new memory, all of it reserved: use never ends in SIGBUS.

    :raises TransportError: if there is not enough memory.
    """
    identity = ".".join(map(str, own_identity()))
    name = f"/manycore-emcos-{os.geteuid()}.{identity}.{next(_numbers)}"
    segment = posix_ipc.SharedMemory(name, posix_ipc.O_CREX, mode=0o600)
    descriptor: int = segment.fd
    try:
        segment.unlink()
        os.posix_fallocate(descriptor, 0, size_bytes)
    except OSError as error:
        os.close(descriptor)
        if error.errno not in (errno.ENOSPC, errno.EFBIG, errno.ENOMEM):
            raise
        raise TransportError(_no_room(size_bytes, subject)) from error
    except BaseException:  # Ctrl-C, while the memory is reserved
        os.close(descriptor)
        raise
    return descriptor


def map_memory(descriptor: int, size_bytes: int) -> Bytes:
    """Return the memory as an array; it is unmapped with the last view.

    :raises TransportError: if the memory is smaller.
    """
    try:
        return np.frombuffer(mmap.mmap(descriptor, size_bytes), np.uint8)
    except ValueError as error:
        raise TransportError(f"expected a segment of {size_bytes} bytes: {error}") from error


def remove_names_of_the_dead() -> list[str]:
    """Unlink what processes of this user left that were killed while they created memory.

    :return: the removed files.
    """
    removed = []
    for file in _DIRECTORY.glob(f"manycore-emcos-{os.geteuid()}.*"):
        if match := _NAME.fullmatch(file.name):
            namespace, pid, start = map(int, match.groups()[1:])
            if has_ended(ProcessIdentity(namespace, pid, start)):
                # Another process was faster; or another user has forged the name.
                with suppress(posix_ipc.Error, OSError):
                    posix_ipc.unlink_shared_memory(f"/{file.name}")
                    removed.append(str(file))
    return removed


def _no_room(size_bytes: int, subject: str) -> str:
    status = os.statvfs(_DIRECTORY)
    free = status.f_bavail * status.f_frsize
    return (
        f"{subject}: no room for {size_bytes} bytes in {_DIRECTORY}, which has {free} free; "
        f"remove what fills it, or enlarge it: `mount -o remount,size=1G {_DIRECTORY}`"
    )
