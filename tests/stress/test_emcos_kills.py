# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A side of a transfer is killed at any moment: nothing is torn, nothing is left.

tests/integration/test_emcos_failures.py kills at named lines; a random kill also hits system calls.
"""

from __future__ import annotations

import random
import threading
from pathlib import Path

import pytest

from rmw_manycore_py.emcos import PeerGoneError
from support import KILLS, TIMEOUT_S
from support.nodes.emcos_ends import OPEN, OTHER, run, use
from support.processes.commands import peer_command
from support.processes.inspection import kill

pytestmark = pytest.mark.stress

LONGEST_LIFE_S = 0.05


@pytest.mark.parametrize("role", OTHER)
def test_a_side_is_killed_at_any_moment(seed, start, platform: str, role: str) -> None:
    pids = []
    for _ in range(max(KILLS // 20, 1)):
        victim = start(peer_command(run, role))
        pids.append(victim.pid)
        with OPEN[OTHER[role]](platform) as end:
            timer = threading.Timer(random.uniform(0, LONGEST_LIFE_S), kill, [victim.pid])
            timer.start()
            with pytest.raises(PeerGoneError, match="ended without closing its side"):
                use(end, OTHER[role])
            timer.join(TIMEOUT_S)
        victim.kill()
    assert not [pid for pid in pids if list(Path("/dev/shm").glob(f"manycore-emcos-*.{pid}.*"))]
