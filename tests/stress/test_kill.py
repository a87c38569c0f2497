# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Any process may be killed at any moment; the others go on, and nothing torn is ever read.

A random kill hits a critical instruction only by chance, so passing proves little about any one of
them; what it shows is that nothing common is wrong. The model in docs/model/ covers the protocol.
"""

from __future__ import annotations

import os
import random
import time

import pytest
from load import breed, check_steadily, publish_steadily
from processes import kill, processes_of, receive_threads_of
from support import (
    IS_MANYCORE,
    KILLS,
    Program,
    example_command,
    leftovers,
    peer_command,
    wait_until,
)

SEED = int(os.environ.get("MANYCORE_TEST_SEED", str(random.randrange(1 << 32))))
LONGEST_LIFE_S = 0.2  # of a victim: joining takes some milliseconds, and may itself be hit
JOINING_S = 0.03  # about what it takes from the fork to the first message
CLUSTERS = 2


class Load:
    """A publisher and two subscriptions that must not notice anything, in two clusters."""

    def __init__(self, start) -> None:
        self.publisher = start(peer_command(publish_steadily, 50.0))
        self.checkers: list[Program] = []
        writer = None
        for cluster in (1, 2):
            # The publisher waits for the first subscription before it says who it is.
            writer = writer or self.publisher.pid
            checker = start(peer_command(check_steadily, writer), cluster)
            checker.wait_for("checking")
            self.checkers.append(checker)
        self.publisher.wait_for(f"publishing as {writer}")

    def counts(self) -> list[tuple[int, int]]:
        """Return how many messages each subscription heard, and how many it misses."""
        for checker in self.checkers:
            checker.say("how many?")
        matches = [checker.wait_for(r"heard (\d+), missing (\d+)") for checker in self.checkers]
        return [(int(match.group(1)), int(match.group(2))) for match in matches]

    def wait_until_it_goes_on(self) -> None:
        """Wait for ten more messages at each subscription."""
        before = self.counts()

        def all_have_more() -> bool:
            pairs = zip(self.counts(), before, strict=True)
            return all(now[0] >= then[0] + 10 for now, then in pairs)

        wait_until(all_have_more, "everybody hears the publisher again")

    def assert_unharmed(self) -> None:
        for program in (self.publisher, *self.checkers):
            assert program.is_running(), program
            assert "torn" not in program.output, program
            assert "wrong order" not in program.output, program
        assert [missing for _, missing in self.counts()] == [0, 0]


@pytest.fixture
def load(start) -> Load:
    print(f"MANYCORE_TEST_SEED={SEED}")
    random.seed(SEED)
    return Load(start)


def test_killed_nodes(start, load):
    """Publishers and subscriptions come, and die at a random moment of their short lives."""
    nursery = start(peer_command(breed))
    nursery.wait_for("ready")
    for number in range(KILLS):
        nursery.say(f"{random.choice(['publisher', 'subscriber'])} {random.randint(1, CLUSTERS)}")
        victim = int(nursery.wait_for(r"born (\d+)").group(1))
        time.sleep(random.uniform(0, LONGEST_LIFE_S))  # the random moment
        kill(victim)
        if number % 50 == 49:
            load.wait_until_it_goes_on()
            load.assert_unharmed()
    load.wait_until_it_goes_on()
    load.assert_unharmed()
    assert "torn" not in nursery.output, nursery


@pytest.mark.skipif(not IS_MANYCORE, reason="only rmw_manycore has receive threads")
def test_killed_receive_threads(platform, load):
    """A receive thread that dies is replaced, and what it had in hand arrives."""
    for _ in range(KILLS // 10):
        wait_until(lambda: receive_threads_of(platform), "there is a receive thread")
        time.sleep(random.uniform(0, LONGEST_LIFE_S))  # the random moment
        kill(random.choice(receive_threads_of(platform)))
        load.wait_until_it_goes_on()
    load.assert_unharmed()


@pytest.mark.skipif(not IS_MANYCORE, reason="only rmw_manycore has receive threads")
def test_everything_dies_at_random(start, platform, load):
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
            kill(victims.pop(random.randrange(len(victims))))
        if random.random() < 0.05:
            for pid in receive_threads_of(platform):
                kill(pid)
    for victim in victims:
        kill(victim)
    load.wait_until_it_goes_on()
    load.assert_unharmed()
    assert "torn" not in nursery.output, nursery


@pytest.mark.skipif(not IS_MANYCORE, reason="about what rmw_manycore leaves in /dev/shm")
def test_the_last_process_is_killed(start, platform):
    """Nobody is left to clean up after the last node but the receive threads, and they do."""
    nursery = start(peer_command(breed))
    nursery.wait_for("ready")
    for _ in range(KILLS // 10):
        nursery.say(f"publisher {random.randint(1, CLUSTERS)}")
        victim = int(nursery.wait_for(r"victim (\d+) works").group(1))
        time.sleep(random.uniform(0, LONGEST_LIFE_S / 4))  # the random moment
        kill(victim)
        wait_until(lambda: not leftovers(platform), "nothing is left in /dev/shm")


@pytest.mark.skipif(not IS_MANYCORE, reason="about what rmw_manycore leaves in /dev/shm")
def test_the_only_process_is_killed_while_it_joins(start, platform):
    """Before there is a receive thread nobody else knows; then the next start clears up."""
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
    assert talker.stop() == 0, talker
    wait_until(lambda: not leftovers(platform), "nothing is left in /dev/shm")
