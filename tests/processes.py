# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Looking at processes from outside."""

from __future__ import annotations

import os
import signal
from contextlib import suppress
from pathlib import Path

from support import PLATFORMS

TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def processes_of(platform: str) -> dict[int, str]:
    """Return pid and program of every process that has the platform mapped or open."""
    directory = f"{PLATFORMS / platform}/"
    return {
        int(process.name): _program(process)
        for process in Path("/proc").iterdir()
        if process.name.isdigit() and _uses(process, directory)
    }


def receive_threads_of(platform: str) -> list[int]:
    """Return the pids of the platform's receive threads."""
    return [pid for pid, program in processes_of(platform).items() if "receive_thread" in program]


def kill(pid: int) -> None:
    """Kill a process that may be gone already."""
    with suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)


def cpu_time_s(pid: int) -> float:
    """Return the CPU time that a process has used."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS_PER_S


def is_stopped(pid: int) -> bool:
    """Tell whether a process has been stopped by a signal."""
    return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] == "T"


def _program(process: Path) -> str:
    with suppress(OSError):
        return str((process / "exe").readlink())
    return ""


def _uses(process: Path, directory: str) -> bool:
    with suppress(OSError):
        if directory in (process / "maps").read_text():
            return True
        return any(str(fd.readlink()).startswith(directory) for fd in (process / "fd").iterdir())
    return False
