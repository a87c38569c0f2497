# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Processes die at any moment while a topic is transferred between clusters.

What is killed with its messages under way may lose them; others go on, in order and untorn, and
sessions, landings and topic DSMs of the dead come back.
"""

from __future__ import annotations

import random
import time

import pytest

from support import IS_MANYCORE, KILLS, wait_until
from support.nodes.load import TOPIC, breed
from support.nodes.steady_load import Load
from support.nodes.transferred import DSM_BYTES, KINDS, configure
from support.processes.commands import peer_command
from support.processes.inspection import kill, receive_threads_of
from support.processes.program import Program

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="transfers are rmw_manycore's")

LONGEST_LIFE_S = 0.2
CLUSTERS = 3  # nothing else runs in the third: its receive thread comes and its nodes go


@pytest.fixture(params=KINDS)
def kind(request: pytest.FixtureRequest, seed, start) -> str:
    kind = str(request.param)
    start(peer_command(configure, kind, [f"/{TOPIC}"], CLUSTERS)).wait_for("configured")
    return kind


@pytest.fixture
def load(kind, start, running_time) -> Load:
    return Load(start, running_time)


@pytest.fixture
def nursery(load, start) -> Program:
    nursery = start(peer_command(breed))
    nursery.wait_for("ready")
    return nursery


def used_bytes(platform: str) -> int:
    from rmw_manycore_py.native._transport import Platform

    with Platform(platform) as view:
        return sum(cluster.used_bytes for cluster in view.clusters())


def wait_until_freed(platform: str, before: int) -> None:
    """Wait until nothing as large as a topic DSM or a landing is held that was not before."""
    wait_until(lambda: used_bytes(platform) < before + DSM_BYTES, "what the dead held is free")


def bear(nursery: Program) -> int:
    """Start a victim in any cluster; return its pid."""
    kind = random.choice(["publisher", "subscriber"])
    nursery.say(f"{kind} {random.randint(1, CLUSTERS)}")
    return int(nursery.wait_for(r"born (\d+)").group(1))


def test_nodes_are_killed(kind, load, nursery, platform):
    load.wait_until_it_goes_on()
    before = used_bytes(platform)
    for _ in range(KILLS // 10):
        victim = bear(nursery)
        time.sleep(random.uniform(0, LONGEST_LIFE_S))  # the random moment
        kill(victim)
    load.wait_until_it_goes_on()
    load.assert_in_order()
    if kind != "message":  # the victims' messages may fill the pipe, and others are dropped then
        assert load.missing() == 0
    assert "torn" not in nursery.output, nursery
    wait_until_freed(platform, before)


def test_nodes_and_receive_threads_are_killed(load, nursery, platform):
    load.wait_until_it_goes_on()
    before = used_bytes(platform)
    victims: list[int] = []
    for _ in range(KILLS // 10):
        victims.append(bear(nursery))
        time.sleep(random.uniform(0, LONGEST_LIFE_S / 2))  # the random moment
        while len(victims) > 3:
            kill(victims.pop(random.randrange(len(victims))))
        for pid in receive_threads_of(platform):
            if random.random() < 0.1:
                kill(pid)
    for victim in victims:
        kill(victim)
    load.wait_until_it_goes_on()
    load.assert_in_order()
    assert "torn" not in nursery.output, nursery
    wait_until_freed(platform, before)
