# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""ROS domains that no other test uses at the same time, in whatever process of this machine."""

from __future__ import annotations

import fcntl
import itertools
import os
import tempfile
from contextlib import suppress
from io import TextIOWrapper
from pathlib import Path

# DDS counts its ports up from 7400 by 250 for each domain. Linux gives those from 32768 on to any
# socket, which are the ports of domain 102.
DOMAINS = range(1, 101)
LOCKS = Path(tempfile.gettempdir()) / f"manycore-test-domains-{os.getuid()}"
# More platforms than one test has. An earlier test's domain is free again then.
KEPT_LEASES = 6

_leases: dict[str, tuple[int, TextIOWrapper]] = {}
_next_domain = itertools.count(os.getpid())


def domain_of(platform: str) -> int:
    """Return the domain of a platform of this process, which holds a lock for it."""
    if platform == os.environ.get("MANYCORE_PLATFORM"):  # the process of one test, or a peer of it
        return int(os.environ["ROS_DOMAIN_ID"])
    if platform not in _leases:
        while len(_leases) >= KEPT_LEASES:
            _leases.pop(next(iter(_leases)))[1].close()
        _leases[platform] = _lease()
    return _leases[platform][0]


def _lease() -> tuple[int, TextIOWrapper]:
    LOCKS.mkdir(exist_ok=True)
    for _ in DOMAINS:
        domain = DOMAINS[next(_next_domain) % len(DOMAINS)]
        file = (LOCKS / str(domain)).open("w")
        with suppress(BlockingIOError):
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return domain, file
        file.close()
    raise RuntimeError(f"every domain from {DOMAINS[0]} to {DOMAINS[-1]} is in use; see {LOCKS}")
