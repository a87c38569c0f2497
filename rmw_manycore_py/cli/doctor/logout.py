# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Doctor check: whether systemd-logind removes this user's shared memory at logout."""

from __future__ import annotations

import configparser
import os
import pwd
from pathlib import Path

from rmw_manycore_py.cli.doctor.finding import Finding, Verdict, advised

SUBJECT = "logout"
# logind.conf(5): files in later directories, and later names, take precedence.
CONFIGURATIONS = (
    "usr/lib/systemd/logind.conf",
    "usr/lib/systemd/logind.conf.d",
    "etc/systemd/logind.conf",
    "etc/systemd/logind.conf.d",
)
FIRST_UID_OF_PEOPLE = 1000  # logind keeps the files of system users
ADVICE = "loginctl enable-linger, or RemoveIPC=no in /etc/systemd/logind.conf"


def check_logout(root: Path = Path("/"), uid: int | None = None) -> Finding:
    """Return whether platforms survive the end of their user's last session."""
    uid = os.getuid() if uid is None else uid
    if not (root / "run/systemd/system").exists():
        return Finding(SUBJECT, Verdict.OK, "systemd does not run here")
    if uid < FIRST_UID_OF_PEOPLE:
        return Finding(SUBJECT, Verdict.OK, "shared memory of system users is kept")
    if not _removes_ipc(root):
        return Finding(SUBJECT, Verdict.OK, "RemoveIPC is off")
    lingers = (root / "var/lib/systemd/linger" / _name_of(uid)).exists()
    found = (
        "RemoveIPC is on; this user lingers"
        if lingers
        else "RemoveIPC is on: running platforms lose their files at the last logout"
    )
    return advised(SUBJECT, lingers, found, ADVICE)


def _removes_ipc(root: Path) -> bool:
    settings = configparser.ConfigParser(strict=False, interpolation=None)
    for name in CONFIGURATIONS:
        path = root / name
        settings.read(sorted(path.glob("*.conf")) if path.is_dir() else path)
    return settings.getboolean("Login", "RemoveIPC", fallback=True)


def _name_of(uid: int) -> str:
    try:
        return pwd.getpwuid(uid).pw_name
    except KeyError:
        return str(uid)
