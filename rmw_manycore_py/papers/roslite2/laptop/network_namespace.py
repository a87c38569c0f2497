# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Network namespace (ip-netns(8)) for the off-loaded nodes, emulating another host."""

from __future__ import annotations

import os
from pathlib import Path

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

_NAMESPACES = Path("/run/netns")
_LOOPBACK = "lo"
_PACKETS = 1  # columns of /proc/PID/net/dev after the name: received bytes, packets


def entering(name: str | None) -> list[str]:
    """Return the command prefix that runs a program in a network namespace.

    :raises ManycoreError: if the namespace does not exist, or the user is not root.
    """
    if name is None:
        return []
    if not (_NAMESPACES / name).exists():
        raise ManycoreError(
            f"--netns: expected a name that 'ip netns list' shows, found '{name}'; "
            f"make it: ip netns add {name}",
            EXIT_BAD_INPUT,
        )
    if os.geteuid() != 0:
        raise ManycoreError("--netns: entering a network namespace needs root", EXIT_BAD_INPUT)
    return ["ip", "netns", "exec", name]


def packets_received(pid: int) -> int | None:
    """Return the packets received by a process's namespace; None after its end."""
    try:
        rows = Path(f"/proc/{pid}/net/dev").read_text().splitlines()[2:]
    except OSError:
        return None
    interfaces = (row.split(":", 1) for row in rows)
    counts = {name.strip(): int(values.split()[_PACKETS]) for name, values in interfaces}
    return sum(packets for name, packets in counts.items() if name != _LOOPBACK)
