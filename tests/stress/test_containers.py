# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Containers that come up on one platform while others are killed, all threads with equal numbers.

docs/model/registry_lock.pml covers each order of steps; here the real kernel and glibc take part.
"""

from __future__ import annotations

import pytest

from support import IS_MANYCORE, KILLS, TIMEOUT_S, wait_until
from support.nodes.containers import bring_up
from support.processes.commands import example_command, peer_command

CONTAINERS = 6

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS has no registry")


def endpoints_of(platform: str) -> int:
    from rmw_manycore_py.native._transport import Platform

    with Platform(platform) as seen:
        return len(seen.endpoints())


def test_containers_come_up_while_others_are_killed(seed, start, platform):
    outside = start(example_command("talker"))
    outside.wait_for("Publishing")
    before = endpoints_of(platform)
    storm = start(peer_command(bring_up, KILLS, CONTAINERS, seed))
    result = storm.wait_for(r"\d+ rounds, \d+ failures", timeout_s=TIMEOUT_S + KILLS)
    assert result.group(0) == f"{KILLS} rounds, 0 failures", storm
    wait_until(lambda: endpoints_of(platform) == before, "all containers are reaped")
    assert "failed" not in storm.output, storm
    assert outside.stop_node(), outside
