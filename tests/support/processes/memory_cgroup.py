# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A memory cgroup of a test: the kernel kills what needs more memory than it has."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

ROOT = Path("/sys/fs/cgroup")
LIMIT = {1: "memory.limit_in_bytes", 2: "memory.max"}
# Without a limit of swap the kernel swaps before it kills; not every kernel has one.
SWAP_LIMIT = {1: "memory.memsw.limit_in_bytes", 2: "memory.swap.max"}
EVENTS = {1: "memory.oom_control", 2: "memory.events"}


class NoMemoryCgroupError(Exception):
    """This user or machine cannot make one; the text says why."""


class MemoryCgroup:
    """Limits processes that write 0 to `procs`, and what they touch from then on."""

    def __init__(self, directory: Path, version: int, limit_bytes: int) -> None:
        self._directory, self._version = directory, version
        self.procs = directory / "cgroup.procs"
        self._write(LIMIT[version], limit_bytes)
        with suppress(OSError):
            self._write(SWAP_LIMIT[version], limit_bytes if version == 1 else 0)

    def kills(self) -> int:
        """Return how many processes the kernel has killed for want of memory."""
        lines = (self._directory / EVENTS[self._version]).read_text().splitlines()
        return int(dict(line.split() for line in lines)["oom_kill"])

    def _write(self, name: str, value: int) -> None:
        (self._directory / name).write_text(str(value))


@contextmanager
def memory_cgroup(limit_bytes: int) -> Iterator[MemoryCgroup]:
    """Make a cgroup, and remove it; its processes have ended by then."""
    version = 1 if (ROOT / "memory").is_dir() else 2
    directory = (ROOT / "memory" if version == 1 else ROOT) / f"manycore-test-{os.getpid()}"
    try:
        directory.mkdir()
    except OSError as error:
        raise NoMemoryCgroupError(f"no memory cgroup can be made: {error}") from error
    try:
        if not (directory / LIMIT[version]).exists():
            raise NoMemoryCgroupError(f"{ROOT} has no memory controller")
        yield MemoryCgroup(directory, version, limit_bytes)
    finally:
        directory.rmdir()
