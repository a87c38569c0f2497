# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""ROS domain ids that no other test on this machine uses at the same time."""

from __future__ import annotations

import fcntl
import itertools
import os
import tempfile
from contextlib import suppress
from io import TextIOWrapper
from pathlib import Path

# DDS port numbers start at 7400 and grow by 250 per domain. Linux assigns ports from 32768 on to
# any socket; domain 102 uses those.
DOMAINS = range(1, 101)
LOCKS = Path(tempfile.gettempdir()) / f"manycore-test-domains-{os.getuid()}"
# More platforms than one test uses: an earlier test's domain is free again by then.
KEPT_LEASES = 6

_leases: dict[str, tuple[int, TextIOWrapper]] = {}
_next_domain = itertools.count(os.getpid())


def domain_of(platform: str) -> int:
    """Return the domain id of a platform of this process, which holds a lock on it."""
    if platform == os.environ.get("MANYCORE_PLATFORM"):  # process or peer of one test
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
