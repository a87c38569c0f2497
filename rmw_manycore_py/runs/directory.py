# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Where runs keep their logs and control sockets, and which of them live.

    $MANYCORE_STATE/runs/PLATFORM/NUMBER/{lock, control, run.json, log/}

The lock is the proof of life: the kernel releases it when the supervisor dies, however it dies.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import shutil
import socket
import stat
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rmw_manycore_py.errors import ManycoreError

STATE_VARIABLE = "MANYCORE_STATE"
LOGS = "log"
_LOCK, _CONTROL, _INFO = "lock", "control", "run.json"
_PRIVATE = 0o700
_OTHERS = 0o077


def state_directory() -> Path:
    """Return the directory of all runs: $MANYCORE_STATE, or as XDG has it."""
    if named := os.environ.get(STATE_VARIABLE):
        return Path(os.path.abspath(named))
    state = os.environ.get("XDG_STATE_HOME", "")
    if not os.path.isabs(state):  # which the specification of XDG has ignored
        state = os.path.expanduser("~/.local/state")
    return Path(state, "rmw_manycore")


def runs_directory() -> Path:
    """Return the directory of the runs whose platforms lie in $MANYCORE_DIRECTORY."""
    chosen = os.environ.get("MANYCORE_DIRECTORY")
    if not chosen:
        return state_directory() / "runs"
    digest = hashlib.sha256(os.path.abspath(chosen).encode()).hexdigest()
    return state_directory() / f"runs-{digest[:8]}"


@dataclass(frozen=True)
class RunDirectory:
    """A run, as it lies in the file system: alive or ended."""

    path: Path

    @property
    def platform(self) -> str:
        """The name of the run's platform."""
        return self.path.parent.name

    @property
    def number(self) -> int:
        """Which run on its platform it is; 1 has started the platform, others joined it."""
        return int(self.path.name)

    @property
    def logs(self) -> Path:
        """The directory of the logs, a file per node."""
        return self.path / LOGS

    @property
    def is_alive(self) -> bool:
        """Tell whether the supervisor lives."""
        try:
            with (self.path / _LOCK).open("rb") as lock:
                fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        except OSError:  # removed, or not yet there
            return False
        return False

    def wait(self) -> None:
        """Wait until the supervisor is gone."""
        with suppress(OSError), (self.path / _LOCK).open("rb") as lock:
            fcntl.flock(lock, fcntl.LOCK_SH)

    @property
    def info(self) -> Mapping[str, Any]:
        """What the supervisor wrote at its start: pid, mapfile, nodes, detached, started."""
        try:
            return dict(json.loads((self.path / _INFO).read_text()))
        except (OSError, ValueError):
            return {}

    @property
    def nodes(self) -> list[str]:
        """The names under which the run's processes print, in their order."""
        return list(self.info.get("nodes", ()))

    def connect(self, timeout_s: float) -> socket.socket:
        """Return a connection to the supervisor; an OSError says that there is none."""
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
    """Return the runs on a platform in their order, those that have ended included."""
    return _runs_in(runs_directory() / platform)


def all_runs() -> list[RunDirectory]:
    """Return the runs of all platforms."""
    with suppress(OSError):
        return [run for entry in sorted(runs_directory().iterdir()) for run in _runs_in(entry)]
    return []


def remove_ended(platform: str | None = None) -> list[Path]:
    """Remove what ended runs have left, of one platform or of all; return the directories."""
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
    """Make the directory of a run and hold its lock; one that does not join replaces ended runs.

    :raises OSError: when the directory cannot be made.
    :raises ManycoreError: when it would not be private, or another run holds the platform.
    """
    directory = runs_directory() / platform
    directory.mkdir(_PRIVATE, parents=True, exist_ok=True)
    _check_private(directory)
    with _locked(directory / _LOCK):
        runs = _runs_in(directory)
        if not joins:
            _check_free(platform, runs)
            for ended in runs:
                shutil.rmtree(ended.path, ignore_errors=True)
            runs = []
        path = directory / str(1 + max((run.number for run in runs), default=0))
        path.mkdir(_PRIVATE)
        lock = _open_lock(path / _LOCK)
        fcntl.flock(lock, fcntl.LOCK_EX)
    try:
        with _listener(path) as listener:
            (path / LOGS).mkdir(_PRIVATE)
            (path / _INFO).write_text(json.dumps({"pid": os.getpid(), **info}))
            yield OwnRun(RunDirectory(path), listener)
    finally:
        with suppress(OSError):
            (path / _CONTROL).unlink()
        os.close(lock)


@dataclass(frozen=True)
class OwnRun:
    """The run of this process."""

    directory: RunDirectory
    listener: socket.socket


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
        entries = [entry for entry in directory.iterdir() if entry.name.isdecimal()]
    except OSError:
        return []
    return [RunDirectory(entry) for entry in sorted(entries, key=lambda entry: int(entry.name))]


def _check_private(directory: Path) -> None:
    status = directory.lstat()
    mode = stat.S_IMODE(status.st_mode)
    if not stat.S_ISDIR(status.st_mode) or status.st_uid != os.geteuid() or mode & _OTHERS:
        raise ManycoreError(
            f"{directory}: expected a directory of this user, closed to others, found owner "
            f"{status.st_uid}, mode {mode:o}; remove it, or: chmod 700 {directory}"
        )


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
    """Name a directory in few letters: addresses of sockets have 107."""
    descriptor = os.open(directory, os.O_PATH | os.O_DIRECTORY)
    try:
        yield f"/proc/self/fd/{descriptor}"
    finally:
        os.close(descriptor)


def _open_lock(path: Path) -> int:
    return os.open(path, os.O_RDWR | os.O_CREAT, 0o600)


@contextmanager
def _locked(path: Path) -> Iterator[None]:
    """Hold a lock for a moment; nothing waits under it."""
    descriptor = _open_lock(path)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)
