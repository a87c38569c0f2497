# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Any process may be killed at any moment; the others go on, and no torn message is ever read.

A random kill hits a critical instruction only by chance, so passing proves little about any single
them; what it shows is that nothing common is wrong. The model in docs/model/ covers the protocol.
"""

from __future__ import annotations

import random
import time

import pytest

from support import IS_MANYCORE, KILLS, wait_until
from support.nodes.load import breed
from support.nodes.steady_load import RECOVERY_S
from support.processes.commands import example_command, peer_command
from support.processes.inspection import kill, processes_of, receive_threads_of
from support.processes.platforms import leftovers

LONGEST_LIFE_S = 0.2  # lifetime of a victim: joining takes some milliseconds, and may be hit, too
JOINING_S = 0.03  # about the time from the fork to the first message
CLUSTERS = 2


def some_receive_threads_of(platform: str) -> list[int]:
    """Wait until there is one; return the pids of all."""
    found: list[int] = []

    def look() -> bool:
        found.extend(receive_threads_of(platform))
        return bool(found)

    wait_until(look, "there is a receive thread")
    return found


def test_killed_nodes(start, load, graves):
    """Publishers and subscriptions join, and die at a random moment of their short lives."""
    nursery = start(peer_command(breed))
    nursery.wait_for("ready")
    for number in range(KILLS):
        nursery.say(f"{random.choice(['publisher', 'subscriber'])} {random.randint(1, CLUSTERS)}")
        victim = int(nursery.wait_for(r"born (\d+)").group(1))
        time.sleep(random.uniform(0, LONGEST_LIFE_S))  # the random moment
        graves.kill(victim)
        graves.assert_reclaimed()
        if number % 50 == 49:
            load.assert_it_goes_on_unharmed()
    graves.assert_survived_by(load, nursery)


@pytest.mark.skipif(not IS_MANYCORE, reason="only rmw_manycore has receive threads")
def test_killed_receive_threads(platform, load):
    """A receive thread that dies is replaced, and the message it was moving arrives."""
    for _ in range(KILLS // 10):
        victim = random.choice(some_receive_threads_of(platform))
        time.sleep(random.uniform(0, LONGEST_LIFE_S))  # the random moment
        kill(victim)
        load.wait_until_it_goes_on()
    load.assert_unharmed()


@pytest.mark.skipif(not IS_MANYCORE, reason="only rmw_manycore has receive threads")
def test_everything_dies_at_random(start, platform, load, graves):
    """Nodes and receive threads die in any order, several at a time."""
    nursery = start(peer_command(breed))
    nursery.wait_for("ready")
    victims: list[int] = []
    for _ in range(KILLS):
        kind = random.choice(["publisher", "subscriber"])
        nursery.say(f"{kind} {random.randint(1, CLUSTERS)}")
        victims.append(int(nursery.wait_for(r"born (\d+)").group(1)))
        time.sleep(random.uniform(0, LONGEST_LIFE_S / 4))  # the random moment
        while len(victims) > 6:
            graves.kill(victims.pop(random.randrange(len(victims))))
        graves.assert_reclaimed()
        if random.random() < 0.05:
            for pid in receive_threads_of(platform):
                kill(pid)
    for victim in victims:
        graves.kill(victim)
    graves.assert_survived_by(load, nursery)


@pytest.mark.skipif(not IS_MANYCORE, reason="about what rmw_manycore leaves in /dev/shm")
def test_the_last_process_is_killed(start, platform, running_time):
    """The receive threads clean up after the last node."""
    nursery = start(peer_command(breed))
    nursery.wait_for("ready")
    for _ in range(KILLS // 10):
        nursery.say(f"publisher {random.randint(1, CLUSTERS)}")
        victim = int(nursery.wait_for(r"victim (\d+) works").group(1))
        some_receive_threads_of(platform)  # the victim may be delayed before it starts one
        time.sleep(random.uniform(0, LONGEST_LIFE_S / 4))  # the random moment
        kill(victim)
        running_time.wait_within(RECOVERY_S, lambda: not leftovers(platform), "all is removed")
        wait_until(lambda: not processes_of(platform), "the receive thread is gone")


@pytest.mark.skipif(not IS_MANYCORE, reason="about what rmw_manycore leaves in /dev/shm")
def test_the_only_process_is_killed_while_it_joins(start, platform):
    """Killed before it has a receive thread, its leftovers are removed by the next start."""
    nursery = start(peer_command(breed))
    nursery.wait_for("ready")
    for _ in range(KILLS // 10):
        nursery.say(f"publisher {random.randint(1, CLUSTERS)}")
        victim = int(nursery.wait_for(r"born (\d+)").group(1))
        time.sleep(random.uniform(0, JOINING_S))  # the random moment
        kill(victim)
        wait_until(lambda: not processes_of(platform), "the receive threads are gone")
    talker = start(example_command("talker"))
    talker.wait_for("Publishing")
    assert talker.stop_node(), talker
    wait_until(lambda: not leftovers(platform), "nothing is left in /dev/shm")
