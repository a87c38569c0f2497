# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Directories and files of runs, which no other user may write: logs reach the terminal."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from rmw_manycore_py.errors import ManycoreError

_PRIVATE = 0o700
_OTHERS = 0o077


def make_private(directory: Path, below: Path) -> None:
    """Create a directory and its missing parents, all private.

    :param below: the first of its parents that has to belong to this user.
    :raises OSError: if one cannot be created.
    :raises ManycoreError: if one belongs to another user, or `directory` is open to others.
    """
    if not below.exists():
        check_own(next(parent for parent in below.parents if parent.exists()), or_root=True)
    for path in reversed((directory, *directory.parents)):
        if not path.exists():
            path.mkdir(_PRIVATE, exist_ok=True)
    check_own(below)
    check_own(directory.parent)
    check_private(directory)


def check_own(directory: Path, *, or_root: bool = False) -> None:
    """Raise a ManycoreError if a directory exists and another user can replace what is in it."""
    try:
        status = directory.stat()
    except OSError:
        return  # missing, or inaccessible: its use will tell
    owners = (os.geteuid(), 0) if or_root else (os.geteuid(),)
    open_to_all = status.st_mode & stat.S_IWOTH and not status.st_mode & stat.S_ISVTX
    if status.st_uid not in owners or open_to_all:
        raise _refusal(directory, status)


def check_private(directory: Path) -> None:
    """Raise a ManycoreError if a directory is another user's, open to others, or a link.

    :raises OSError: if there is none.
    """
    descriptor = os.open(directory, os.O_PATH | os.O_NOFOLLOW)
    try:
        status = os.fstat(descriptor)
    finally:
        os.close(descriptor)
    is_own = stat.S_ISDIR(status.st_mode) and status.st_uid == os.geteuid()
    if not is_own or status.st_mode & _OTHERS:
        raise _refusal(directory, status)


def write_private(file: Path, text: str) -> None:
    """Create a file that only this user can read or write, whatever the umask is."""
    descriptor = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "w", encoding="utf-8") as opened:
        opened.write(text)


def _refusal(directory: Path, status: os.stat_result) -> ManycoreError:
    return ManycoreError(
        f"{directory}: expected a directory of this user, closed to others, found owner "
        f"{status.st_uid}, mode {stat.S_IMODE(status.st_mode):o}; remove it, or: "
        f"chmod 700 {directory}"
    )
