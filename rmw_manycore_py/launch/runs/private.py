# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Directories and files of runs, which no other user may write: logs reach the terminal."""

from __future__ import annotations

import grp
import os
import pwd
import shlex
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
    check_own(below)
    for path in reversed((directory, *directory.parents)):
        if not path.exists():
            path.mkdir(_PRIVATE, exist_ok=True)
    check_own(below)
    check_own(directory.parent)
    check_private(directory)


def check_own(directory: Path) -> None:
    """Raise a ManycoreError if another user can replace a directory or its contents.

    It may be missing: then this is a check of the parent that exists.
    """
    try:
        _check_parent(next((one for one in directory.parents if one.exists()), directory))
        status = directory.lstat()
    except OSError:
        return  # missing or inaccessible: using it reports the error
    if status.st_uid != os.geteuid() or stat.S_ISLNK(status.st_mode) or _is_writable(status):
        raise _refusal(directory, status)


def check_private(directory: Path) -> None:
    """Raise a ManycoreError if a directory is another user's, open to others, or a link.

    :raises OSError: if there is none.
    """
    status = directory.lstat()
    is_own = stat.S_ISDIR(status.st_mode) and status.st_uid == os.geteuid()
    if not is_own or status.st_mode & _OTHERS:
        raise _refusal(directory, status)


def write_private(file: Path, text: str) -> None:
    """Create a file that only this user can read or write, whatever the umask is."""
    descriptor = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "w", encoding="utf-8") as opened:
        opened.write(text)


def replace_private(file: Path, text: str) -> None:
    """Write such a file in place of an earlier one, which stays whole until then."""
    new = file.with_name(f"{file.name}.new")
    new.unlink(missing_ok=True)
    write_private(new, text)
    os.replace(new, file)


def _check_parent(parent: Path) -> None:
    """Raise a ManycoreError if another user can replace an own directory in it."""
    status = parent.stat()
    # The sticky bit lets others create directories, as in /tmp, but not replace them.
    is_open = _is_writable(status) and not status.st_mode & stat.S_ISVTX
    if status.st_uid in (os.geteuid(), 0) and not is_open:
        return
    advice = "choose another MANYCORE_STATE"
    if status.st_uid == os.geteuid():
        advice = f"`chmod go-w {shlex.quote(str(parent))}`"
    raise ManycoreError(
        f"{parent}: expected a directory in which no other user can replace the runs of this "
        f"user, found {_owner_and_mode(status)}; {advice}"
    )


def _is_writable(status: os.stat_result) -> bool:
    """Return whether others than the owner may create files in a directory."""
    by_group = status.st_mode & stat.S_IWGRP and not _is_own_group(status.st_gid)
    return bool(status.st_mode & stat.S_IWOTH or by_group)


def _is_own_group(gid: int) -> bool:
    """Return whether a group is the one that only this user is in.

    Distributions that give each user such a group have umask 002.
    """
    try:
        user, group = pwd.getpwuid(os.geteuid()), grp.getgrgid(gid)
    except KeyError:
        return False
    is_primary = (gid, group.gr_name) == (user.pw_gid, user.pw_name)
    return is_primary and set(group.gr_mem) <= {user.pw_name}


def _refusal(directory: Path, status: os.stat_result) -> ManycoreError:
    return ManycoreError(
        f"{directory}: expected a directory of this user, closed to others, "
        f"found {_owner_and_mode(status)}; {_advice(directory, status)}"
    )


def _owner_and_mode(status: os.stat_result) -> str:
    link = "a link, " if stat.S_ISLNK(status.st_mode) else ""
    return f"{link}owner {status.st_uid}, mode {stat.S_IMODE(status.st_mode):o}"


def _advice(directory: Path, status: os.stat_result) -> str:
    path = shlex.quote(str(directory))
    if status.st_uid != os.geteuid():
        return "choose another MANYCORE_STATE"
    if not stat.S_ISDIR(status.st_mode):
        return f"`rm {path}`, or choose another MANYCORE_STATE"
    if status.st_mode & stat.S_ISVTX:  # a directory that is meant for all users, as /tmp is
        return f"`mkdir -p -m 700 {path}/manycore`, and choose that as MANYCORE_STATE"
    return f"`chmod 700 {path}`"
