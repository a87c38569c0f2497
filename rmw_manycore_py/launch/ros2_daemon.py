# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The ros2cli daemon: a hidden node that lives two hours after `ros2 topic list`."""

from __future__ import annotations

import os
import select
import signal
from contextlib import suppress
from pathlib import Path

from rmw_manycore_py.native import _transport
from rmw_manycore_py.native._transport import ProcessInfo

CURE = "ros2 daemon stop"
_NODE = "_ros2cli_daemon_"  # name defined in ros2cli/daemon/__init__.py
_MODULE = b"ros2cli.daemon"
# The daemon checks for signals every 0.2 s.
_GRACE_MS = 3000


def is_daemon(platform: _transport.Platform, process: ProcessInfo) -> bool:
    """Return whether a process is the daemon, by its nodes and command line."""
    names = [node.name for node in platform.nodes() if node.process == process.slot]
    if not names or not all(name.startswith(_NODE) for name in names):
        return False
    with suppress(OSError):
        return _MODULE in Path(f"/proc/{process.pid}/cmdline").read_bytes()
    return False


def end_lone_daemons(name: str) -> list[int]:
    """Stop daemons on a platform without other processes; return their process ids.

    ros2 restarts a daemon on demand: only its cache is lost.
    """
    pids = lone_daemons(name)
    for pid in pids:
        _end(pid)
    return pids


def lone_daemons(name: str) -> list[int]:
    """Return the process ids of daemons on a platform without other processes."""
    if name not in _transport.platforms():
        return []
    try:
        with _transport.Platform(name) as platform:
            living = [process for process in platform.processes() if process.alive]
            if not living or not all(is_daemon(platform, process) for process in living):
                return []
    except _transport.PlatformError:
        return []  # the platform was removed meanwhile
    return [process.pid for process in living]


def _end(pid: int) -> None:
    try:
        pidfd = os.pidfd_open(pid)
    except ProcessLookupError:
        return
    try:
        for number in (signal.SIGTERM, signal.SIGKILL):
            with suppress(ProcessLookupError):
                signal.pidfd_send_signal(pidfd, number)
            poll = select.poll()
            poll.register(pidfd, select.POLLIN)
            if poll.poll(_GRACE_MS):
                return
    finally:
        os.close(pidfd)
