# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Directories of runs with their logs and control sockets, and which runs are alive.

    $MANYCORE_STATE/runs/PLATFORM/NUMBER/{lock, control, run.json, log/, parameters/}

The lock proves that a run is alive: the kernel releases it when the supervisor dies.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import shutil
import socket
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.runs.private import (
    check_own,
    check_private,
    make_private,
    replace_private,
    write_private,
)

STATE_VARIABLE = "MANYCORE_STATE"
LOGS = "log"
_LOCK, _CONTROL, _INFO = "lock", "control", "run.json"


def state_directory() -> Path:
    """Return the directory of all runs: $MANYCORE_STATE, or the XDG default."""
    if named := os.environ.get(STATE_VARIABLE):
        return Path(os.path.abspath(named))
    state = os.environ.get("XDG_STATE_HOME", "")
    if not os.path.isabs(state):  # ignored, as the XDG specification requires
        state = os.path.expanduser("~/.local/state")
    return Path(state, "rmw_manycore")


def runs_directory() -> Path:
    """Return the directory of runs whose platforms are in $MANYCORE_DIRECTORY."""
    chosen = os.environ.get("MANYCORE_DIRECTORY")
    if not chosen:
        return state_directory() / "runs"
    digest = hashlib.sha256(os.path.abspath(chosen).encode()).hexdigest()
    return state_directory() / f"runs-{digest[:8]}"


@dataclass(frozen=True)
class RunDirectory:
    """Directory of a run, alive or ended."""

    path: Path

    @property
    def platform(self) -> str:
        """Name of the run's platform."""
        return self.path.parent.name

    @property
    def number(self) -> int:
        """Number of the run on its platform; run 1 created the platform, others joined it."""
        return int(self.path.name)

    @property
    def logs(self) -> Path:
        """Directory of the logs, one file per node."""
        return self.path / LOGS

    @property
    def is_alive(self) -> bool:
        """Return whether the supervisor is alive."""
        try:
            with (self.path / _LOCK).open("rb") as lock:
                fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        except OSError:  # removed or not created yet
            return False
        return False

    def wait(self) -> None:
        """Wait until the supervisor has ended."""
        with suppress(OSError), (self.path / _LOCK).open("rb") as lock:
            fcntl.flock(lock, fcntl.LOCK_SH)

    @property
    def killed_after(self) -> datetime | None:
        """Return the last sign of life of a supervisor that was killed; None for other runs.

        A supervisor that ends removes its socket before it releases the lock.
        """
        if self.is_alive or not (self.path / _CONTROL).exists():
            return None
        times_s = [0.0]
        for file in (self.path / _INFO, *self.logs.glob("*")):
            with suppress(OSError):
                times_s.append(file.stat().st_mtime)
        return datetime.fromtimestamp(max(times_s)).astimezone()

    def forget(self) -> None:
        """Treat a killed run as one that has ended."""
        if not self.is_alive:
            (self.path / _CONTROL).unlink(missing_ok=True)

    @property
    def info(self) -> Mapping[str, Any]:
        """Facts written by the supervisor at its start, as pid, mapfile, host, nodes, started."""
        try:
            info = json.loads((self.path / _INFO).read_text())
        except (OSError, ValueError, RecursionError):
            return {}
        return info if isinstance(info, dict) else {}

    @property
    def nodes(self) -> list[str]:
        """Names under which the run's processes print, in order."""
        nodes = self.info.get("nodes")
        return [str(name) for name in nodes] if isinstance(nodes, list) else []

    def connect(self, timeout_s: float) -> socket.socket:
        """Return a connection to the supervisor; raise OSError if there is none."""
        connection = socket.socket(socket.AF_UNIX)
        connection.settimeout(timeout_s)
        try:
            with _short_path(self.path) as directory:
                connection.connect(f"{directory}/{_CONTROL}")
        except OSError:
            connection.close()
            raise
        return connection


def runs_of(platform: str) -> list[RunDirectory]:
    """Return the runs of a platform in order, including ended ones.

    :raises ManycoreError: if a directory that holds them belongs to another user.
    """
    check_own(state_directory())
    return _runs_in(runs_directory() / platform)


def all_runs() -> list[RunDirectory]:
    """Return the runs of all platforms."""
    check_own(state_directory())
    platforms: list[str] = []
    with suppress(OSError), os.scandir(runs_directory()) as entries:
        platforms = sorted(one.path for one in entries if one.is_dir(follow_symlinks=False))
    return [run for platform in platforms for run in _runs_in(Path(platform))]


def remove_ended(platform: str | None = None) -> list[Path]:
    """Remove the directories of ended runs, of one or all platforms; return their paths."""
    removed = []
    for run in all_runs() if platform is None else runs_of(platform):
        with _locked(run.path.parent / _LOCK):
            if not run.is_alive:
                shutil.rmtree(run.path, ignore_errors=True)
                removed.append(run.path)
        with suppress(OSError):
            if not _runs_in(run.path.parent):
                shutil.rmtree(run.path.parent)
    return removed


@contextmanager
def new_run(platform: str, info: Mapping[str, Any], joins: bool) -> Iterator[OwnRun]:
    """Create the directory of a run and hold its lock; unless it joins, remove ended runs.

    :raises OSError: if the directory cannot be created.
    :raises ManycoreError: if it would not be private, or another run holds the platform.
    """
    directory = runs_directory() / platform
    make_private(directory, below=state_directory())
    with _locked(directory / _LOCK):
        runs = _runs_in(directory)
        if not joins:
            _check_free(platform, runs)
            for ended in runs:
                shutil.rmtree(ended.path, ignore_errors=True)
            runs = []
        for run in runs:  # this run may take up a killed one
            if run.info.get("mapfile") == info.get("mapfile"):
                run.forget()
        path = directory / str(1 + max((run.number for run in runs), default=0))
        path.mkdir(0o700)
        lock = _open_lock(path / _LOCK)
        fcntl.flock(lock, fcntl.LOCK_EX)
    try:
        with _listener(path) as listener:
            (path / LOGS).mkdir(0o700)
            write_private(path / _INFO, json.dumps({"pid": os.getpid(), **info}))
            yield OwnRun(RunDirectory(path), listener)
    finally:
        with suppress(OSError):
            (path / _CONTROL).unlink()
        os.close(lock)


@dataclass(frozen=True)
class OwnRun:
    """Run of this process."""

    directory: RunDirectory
    listener: socket.socket

    def record(self, nodes: list[str]) -> None:
        """Store other names of the run's processes."""
        info = {**self.directory.info, "nodes": nodes}
        replace_private(self.directory.path / _INFO, json.dumps(info))


def _check_free(platform: str, runs: list[RunDirectory]) -> None:
    for run in runs:
        if run.is_alive:
            info = run.info
            raise ManycoreError(
                f"platform '{platform}' is running already: {info.get('mapfile', 'a mapfile')}, "
                f"pid {info.get('pid', 'unknown')}; `manycore stop --platform {platform}` stops "
                "it, --join adds nodes to it"
            )


def _runs_in(directory: Path) -> list[RunDirectory]:
    try:
        check_private(directory)
        entries = [entry for entry in directory.iterdir() if entry.name.isdecimal()]
    except OSError:
        return []
    return [RunDirectory(entry) for entry in sorted(entries, key=lambda entry: int(entry.name))]


@contextmanager
def _listener(path: Path) -> Iterator[socket.socket]:
    with socket.socket(socket.AF_UNIX) as listener:
        with _short_path(path) as directory:
            listener.bind(f"{directory}/{_CONTROL}")
        (path / _CONTROL).chmod(0o600)
        listener.listen()
        listener.setblocking(False)
        yield listener


@contextmanager
def _short_path(directory: Path) -> Iterator[str]:
    """Yield a short path of a directory: socket addresses are limited to 107 bytes."""
    descriptor = os.open(directory, os.O_PATH | os.O_DIRECTORY)
    try:
        yield f"/proc/self/fd/{descriptor}"
    finally:
        os.close(descriptor)


def _open_lock(path: Path) -> int:
    return os.open(path, os.O_RDWR | os.O_CREAT, 0o600)


@contextmanager
def _locked(path: Path) -> Iterator[None]:
    """Hold a lock briefly; nothing may block under it."""
    descriptor = _open_lock(path)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)
