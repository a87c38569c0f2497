# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Inspection of processes from outside."""

from __future__ import annotations

import os
import signal
from contextlib import suppress
from pathlib import Path

from support import wait_until
from support.processes.platforms import PLATFORMS, entries

TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def processes_of(platform: str, program: str = "") -> dict[int, str]:
    """Return pid and program of every process that has the platform mapped or open.

    Only programs with `program` in their path are examined: reading all of /proc takes long.
    """
    directory = f"{PLATFORMS / platform}/"
    return {
        int(process.name): path
        for process in Path("/proc").iterdir()
        if process.name.isdigit()
        and program in (path := _program(process))
        and _uses(process, directory)
    }


def receive_threads_of(platform: str) -> list[int]:
    """Return the pids of the platform's receive threads."""
    return list(processes_of(platform, "receive_thread"))


def has_receive_threads(platform: str) -> bool:
    """Return whether every cluster that a process has joined has its receive thread.

    Nothing replaces one that was killed after the last process of its cluster.
    """
    clusters = len(entries(PLATFORMS / platform, "cluster-*.pipe"))
    missing = clusters - len(receive_threads_of(platform))
    return missing <= 0 or missing <= _deserted_clusters(platform)


def _deserted_clusters(platform: str) -> int:
    """Return how many clusters without a process have lost their receive thread."""
    from rmw_manycore_py.native._transport import Platform, PlatformError

    try:
        with Platform(platform) as view:
            clusters = view.clusters()
            inhabited = {process.cluster for process in view.processes() if process.alive}
    except PlatformError:  # just made, or already removed
        return 0
    return sum(
        cluster.receive_thread_pid != 0 and not cluster.alive and cluster.id not in inhabited
        for cluster in clusters
    )


def kill(pid: int) -> None:
    """Kill a process that may have ended already."""
    with suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)


def stop_all(platform: str) -> None:
    """Stop all processes of a platform: they live, but do not run."""
    wait_until(lambda: has_receive_threads(platform), "no receive thread is on its way")
    wait_until(lambda: _stop_all(platform), f"all processes of {platform} are stopped")


def kill_all(platform: str) -> None:
    """Kill all processes of a platform, stopped first so that none sees another one die.

    Else a receive thread might clean up after the others, or be replaced, before it is killed.
    """
    stop_all(platform)
    for pid in processes_of(platform):
        kill(pid)
    wait_until(lambda: not processes_of(platform), f"all processes of {platform} are gone")


def _stop_all(platform: str) -> bool:
    """Stop what still runs; return whether all were stopped already."""
    running = [pid for pid in processes_of(platform) if not is_stopped(pid)]
    for pid in running:
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGSTOP)
    return not running


def cpu_time_s(pid: int) -> float:
    """Return the CPU time [s] that a process has used."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS_PER_S


def times_run(pid: int) -> int:
    """Return how often the main thread of a process was given a CPU."""
    return int(Path(f"/proc/{pid}/schedstat").read_text().split()[2])


def is_stopped(pid: int) -> bool:
    """Return whether all threads of a process are stopped by a signal; False if it has ended."""
    return _states_of(pid) == {"T"}


def is_asleep(pid: int) -> bool:
    """Return whether all threads of a process sleep; False if it has ended."""
    return _states_of(pid) == {"S"}


def _states_of(pid: int) -> set[str]:
    """Return the state letters of a process's threads, see proc(5); none if it has ended."""
    with suppress(FileNotFoundError, ProcessLookupError):
        threads = Path(f"/proc/{pid}/task").iterdir()
        return {(thread / "stat").read_text().rsplit(")", 1)[1].split()[0] for thread in threads}
    return set()


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
