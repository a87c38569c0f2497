# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Doctor checks: shared memory, CPUs, kernel, leftover platforms."""

from __future__ import annotations

import ctypes
import os
import platform
import shlex
import stat
from collections.abc import Iterator
from pathlib import Path

import posix_ipc

from rmw_manycore_py.cli.common.printing import size_text
from rmw_manycore_py.cli.doctor.clusters import check_clusters
from rmw_manycore_py.cli.doctor.daemons import check_daemons
from rmw_manycore_py.cli.doctor.finding import Finding, Verdict, advised, judged
from rmw_manycore_py.cli.doctor.logout import check_logout
from rmw_manycore_py.cli.doctor.scheduling import check_isolation, check_real_time
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.platform.topology import platforms_directory, shared_memory_place

# Two Coolidge clusters and the registry: the minimum for the examples.
USEFUL_SHARED_MEMORY_BYTES = 64 << 20
USEFUL_CPUS = 2
_FUTEX_WAKE = 1  # <linux/futex.h>
_SYS_FUTEX = {"x86_64": 202, "aarch64": 98}


def check_machine() -> Iterator[Finding]:
    """Yield findings about what the transport needs from the system."""
    try:
        yield _shared_memory_size()
    except ManycoreError as error:
        yield Finding("platform directory", Verdict.FAILURE, str(error))
    else:
        yield _user_directory()
    yield _posix_shared_memory()
    yield _cpus()
    yield from check_clusters()
    yield check_isolation()
    yield check_real_time()
    yield _pidfd()
    yield _futex()
    yield check_logout()
    yield _stale_platforms()
    yield from check_daemons()


def _shared_memory_size() -> Finding:
    place = shared_memory_place()
    status = os.statvfs(place)
    size, free = status.f_blocks * status.f_frsize, status.f_bavail * status.f_frsize
    enlarge = f"`mount -o remount,size=1G {shlex.quote(_mount_point(place))}`"
    advice = f"{enlarge} (a container: --shm-size=1g), or remove what fills it"
    found = f"{size_text(free)} free of {size_text(size)}"
    return advised(str(place), free >= USEFUL_SHARED_MEMORY_BYTES, found, advice)


def _mount_point(path: Path) -> str:
    return next(str(place) for place in (path, *path.parents) if os.path.ismount(place))


def _posix_shared_memory() -> Finding:
    """Create a segment as any program would, and remove it."""
    subject, name = "POSIX shared memory", f"/manycore-doctor-{os.getpid()}"
    try:
        segment = posix_ipc.SharedMemory(name, posix_ipc.O_CREX, mode=0o600, size=4096)
    except (OSError, posix_ipc.Error) as error:
        advice = "give this user the right to write to /dev/shm (mode 1777)"
        return Finding(subject, Verdict.FAILURE, f"cannot create a segment: {error}", advice)
    segment.close_fd()
    segment.unlink()
    return Finding(subject, Verdict.OK, "works")


def _user_directory() -> Finding:
    path = platforms_directory()
    if os.environ.get("MANYCORE_DIRECTORY"):
        path = path.resolve()  # a user may choose a link
    try:
        status = path.lstat()
    except FileNotFoundError:
        return Finding("platform directory", Verdict.OK, f"{path}: created at the first start")
    mode = stat.S_IMODE(status.st_mode)
    is_own = stat.S_ISDIR(status.st_mode) and status.st_uid == os.geteuid()
    found = f"{path}, owner {status.st_uid}, mode {mode:o}"
    advice = _advice(path, is_own, bool(mode & stat.S_ISVTX))
    return judged("platform directory", is_own and mode == 0o700, found, advice)


def _advice(path: Path, is_own: bool, is_for_all: bool) -> str:
    quoted = shlex.quote(str(path))
    if is_for_all:  # the sticky bit, as of /tmp
        return f"`mkdir -p -m 700 {quoted}/manycore`, and choose that as MANYCORE_DIRECTORY"
    if is_own:
        return f"`chmod 700 {quoted}`"
    if os.environ.get("MANYCORE_DIRECTORY"):
        return "choose a directory of this user as MANYCORE_DIRECTORY"
    return "remove it (or ask its owner to)"


def _cpus() -> Finding:
    cpus = sorted(os.sched_getaffinity(0))
    found = f"{len(cpus)} usable: {', '.join(map(str, cpus))}"
    advice = "nodes share a CPU: results are correct, but timing is meaningless"
    return advised("host CPUs", len(cpus) >= USEFUL_CPUS, found, advice)


def _pidfd() -> Finding:
    subject, found = "pidfd", f"Linux {platform.release()}"
    try:
        os.close(os.pidfd_open(os.getpid()))
    except OSError as error:
        return Finding(
            subject,
            Verdict.FAILURE,
            f"{found}: {error.strerror}",
            "use Linux 5.3 or later, and a container that allows pidfd_open",
        )
    return Finding(subject, Verdict.OK, found)


def _futex() -> Finding:
    """Call FUTEX_WAKE on a private word without waiters; an error means futex is blocked."""
    number = _SYS_FUTEX.get(platform.machine())
    if number is None:
        found = f"not checked on {platform.machine()}"
        return Finding("futex", Verdict.OK, found)
    word = ctypes.c_int(0)
    result = ctypes.CDLL(None, use_errno=True).syscall(
        number, ctypes.byref(word), _FUTEX_WAKE, 1, None, None, 0
    )
    found = "works" if result == 0 else os.strerror(ctypes.get_errno())
    return judged("futex", result == 0, found, "use a kernel or container that allows futex")


def _stale_platforms() -> Finding:
    subject = "platforms"
    try:
        from rmw_manycore_py.native import _transport
        from rmw_manycore_py.native.platforms import is_alive
    except ImportError as error:
        return Finding(subject, Verdict.FAILURE, f"not checked: {error}")
    try:
        names = _transport.platforms()
    except _transport.PlatformError as error:
        return Finding(subject, Verdict.FAILURE, str(error))
    dead = [name for name in names if not is_alive(name)]
    alive = len(names) - len(dead)
    found = f"{alive} alive" + (f", dead or unreadable: {', '.join(dead)}" if dead else "")
    advice = "run `manycore clean`; if one remains, it reports the reason"
    return advised(subject, not dead, found, advice)
