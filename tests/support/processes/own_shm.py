# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Programs with a /dev/shm of their own, which only root can give them."""

from __future__ import annotations

import os
import subprocess

_MOUNT = 'mount -t tmpfs -o size={size_mib}m,mode=1777 tmpfs /dev/shm && exec "$@"'


def own_shm_command(size_mib: int, command: list[str]) -> list[str]:
    """Return a command that runs with a /dev/shm of its own."""
    script = _MOUNT.format(size_mib=size_mib)
    return ["unshare", "--mount", "sh", "-c", script, "sh", *map(str, command)]


def can_mount() -> bool:
    """Return whether this user may mount file systems in a mount namespace."""
    if os.getuid() != 0:
        return False
    return subprocess.run(own_shm_command(1, ["true"]), capture_output=True).returncode == 0
