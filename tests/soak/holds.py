# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages without copies under random holds, copies, changes, forks and kills.

Readers check each byte of what they take and keep. After each round only one of them is left, and
what the platform and it then hold is compared over the rounds.
"""

from __future__ import annotations

import argparse
import random
import sys
import time
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from soak.growth import Record, grown
from soak.holdings import Holdings, look
from soak.keepers import GO_ON, REST, TOLD, keep, publish_kept
from soak.soak import programs_on
from support import wait_until
from support.processes.commands import peer_command
from support.processes.platforms import leftovers, unique_platform
from support.processes.program import Program

CLUSTERS = 2
ROUNDS = 20
LIFE_S = 0.5  # mean time between two kills
WRONG = ("torn", "foreign", "Traceback")

Start = Callable[..., Program]
Role = tuple[Callable[..., None], tuple[str, ...]]  # what it runs, its topic and more
PUBLISHER: Role = (publish_kept, ("shared",))
LASTING: Role = (keep, ("shared", "read_only"))
VICTIMS: list[Role] = [
    (publish_kept, ("alone",)),
    (keep, ("alone", "sole")),
    PUBLISHER,
    (keep, ("shared", "sole")),
    LASTING,  # a second one
]


class Holds:
    """A reader that stays, and publishers and readers that are killed and started again."""

    def __init__(self, start: Start, platform: str) -> None:
        self._start = start
        self._platform = platform
        self._lasting = self._started(LASTING)
        self._own_endpoints = self._look().endpoints
        self._victims: dict[Role, Program] = {}
        self._takes_of_dead = 0
        self.kills = 0
        for cluster in range(1, CLUSTERS + 1):
            self._meet(cluster)

    @property
    def takes(self) -> int:
        """Number of messages that were taken."""
        living = [self._lasting, *self._victims.values()]
        return self._takes_of_dead + sum(_takes(program) for program in living)

    def churn(self, takes: int) -> None:
        """Start and kill until all readers together have taken that many more messages."""
        self._tell(GO_ON)
        end = self.takes + takes
        while self.takes < end:
            for role in VICTIMS:
                if role not in self._victims:
                    self._victims[role] = self._started(role)
            time.sleep(random.uniform(0, 2 * LIFE_S))
            for program in (self._lasting, *self._victims.values()):
                _raise_if_ended(program)
            self._kill(random.choice(VICTIMS))

    def rest(self) -> Holdings:
        """End all but the lasting reader, and return what is held then."""
        for role in list(self._victims):
            self._kill(role)
        self._tell(REST)
        _raise_if_wrong(self._lasting)
        wait_until(self._is_alone, "what the killed held is reclaimed")
        return self._look()

    def _meet(self, cluster: int) -> None:
        """Let the lasting reader take from a cluster, whose segment it then keeps mapped."""
        before = _takes(self._lasting)
        self._victims[PUBLISHER] = self._started(PUBLISHER, cluster)
        wait_until(lambda: _takes(self._lasting) > before, f"messages come from cluster {cluster}")
        self._kill(PUBLISHER)

    def _tell(self, command: str) -> None:
        """Tell the lasting reader to keep messages or none."""
        self._lasting.say(command)
        self._lasting.wait_for(command)

    def _look(self) -> Holdings:
        return look(self._platform, [self._lasting.pid])

    def _is_alone(self) -> bool:
        held = self._look()
        return held.process_slots == 1 and held.endpoints == self._own_endpoints

    def _started(self, role: Role, cluster: int | None = None) -> Program:
        function, arguments = role
        place = cluster or random.randint(1, CLUSTERS)
        program = self._start(peer_command(function, *arguments), place)
        program.wait_for("works")
        return program

    def _kill(self, role: Role) -> None:
        program = self._victims.pop(role)
        _raise_if_ended(program)
        program.kill()
        self.kills += 1
        self._takes_of_dead += _takes(program)
        _raise_if_wrong(program)


def _takes(program: Program) -> int:
    return TOLD * program.lines.count("took")


def _raise_if_ended(program: Program) -> None:
    assert program.is_running(), f"ended by itself: {program}"


def _raise_if_wrong(program: Program) -> None:
    wrong = [line for line in program.lines if line.startswith(WRONG)]
    assert not wrong, f"{wrong[0]} in the output of {program}"


def soak(takes: int, record: Record) -> None:
    """Soak a new platform, and write what it holds at the end of each round into the record."""
    platform = unique_platform()
    start_s = time.monotonic()
    with programs_on(platform) as start:
        holds = Holds(start, platform)
        for _ in range(ROUNDS):
            holds.churn(takes // ROUNDS)
            record.add(time.monotonic() - start_s, True, holds.rest())
            print(f"{holds.takes} takes, {holds.kills} kills: {record.rests()[-1]}", flush=True)
    wait_until(lambda: not leftovers(platform), f"{platform} leaves nothing in /dev/shm")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--takes", type=int, default=1_000_000)
    parser.add_argument("--output", type=Path, default=Path("build/soak-holds"))
    parser.add_argument("--seed", type=int, default=random.randrange(1 << 32))
    options = parser.parse_args()
    random.seed(options.seed)
    print(f"seed {options.seed}", flush=True)
    record = Record(options.output)
    try:
        soak(options.takes, record)
    finally:
        print(f"see {record.draw()}")
    found = grown(record.rests())
    print("\n".join(found) or "nothing grew")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
