# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a platform and its lasting processes hold at a moment."""

from __future__ import annotations

import os
import re
from contextlib import suppress
from dataclasses import dataclass, fields
from pathlib import Path

from rmw_manycore_py.native._transport import Platform
from support.processes.platforms import PLATFORMS

BLOCK_BYTES = 512  # of st_blocks, see stat(2)


@dataclass(frozen=True)
class Holdings:
    """Resources of the platform, then of the lasting processes and its receive threads together."""

    smem_used_bytes: int
    backed_bytes: int
    files: int
    process_slots: int
    nodes: int
    endpoints: int
    descriptors: int
    threads: int
    private_bytes: int

    @classmethod
    def names(cls) -> list[str]:
        return [field.name for field in fields(cls)]


def look(platform: str, lasting: list[int]) -> Holdings:
    """Return what is held now; `lasting` are the pids of the lasting processes."""
    with Platform(platform) as seen:
        clusters = seen.clusters()
        pids = [*lasting, *(cluster.receive_thread_pid for cluster in clusters if cluster.alive)]
        statistics = [status for path in _files_of(platform) if (status := _status(path))]
        return Holdings(
            smem_used_bytes=sum(cluster.used_bytes for cluster in clusters),
            backed_bytes=sum(status.st_blocks * BLOCK_BYTES for status in statistics),
            files=len(statistics),
            process_slots=len(seen.processes()),
            nodes=len(seen.nodes()),
            endpoints=len(seen.endpoints()),
            descriptors=sum(_count(pid, "fd") for pid in pids),
            threads=sum(_count(pid, "task") for pid in pids),
            private_bytes=sum(_private_bytes(pid) for pid in pids),
        )


def _files_of(platform: str) -> list[Path]:
    return list((PLATFORMS / platform).rglob("*"))


def _status(path: Path) -> os.stat_result | None:
    with suppress(FileNotFoundError):
        return path.stat()
    return None


def _count(pid: int, what: str) -> int:
    with suppress(OSError):
        return len(os.listdir(f"/proc/{pid}/{what}"))
    return 0


def _private_bytes(pid: int) -> int:
    """Return the private memory of a process, without the segments that it maps."""
    with suppress(OSError):
        found = re.search(r"RssAnon:\s+(\d+) kB", Path(f"/proc/{pid}/status").read_text())
        return int(found.group(1)) * 1024 if found else 0
    return 0
