# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A platform under churn, growth and random kills for hours: what it holds must stay flat.

Some nodes stay and check that they notice nothing. Others join, publish more and more, get stuck,
leave or are killed, as are receive threads. Once a minute all of them are gone, and what is then
held is compared over time.
"""

from __future__ import annotations

import argparse
import os
import random
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from rmw_manycore_py.native._transport import Platform
from rmw_manycore_py.platform.monitor.graph import read_graph
from rmw_manycore_py.platform.monitor.sample import QUEUED, take_sample
from soak.actors import ACTORS, RENEW, breed_actors, publish_bursts
from soak.growth import Record, grown
from soak.holdings import Holdings, look
from support import wait_until
from support.nodes.steady_load import Load
from support.peers.client import PeerServers
from support.processes.commands import peer_command
from support.processes.inspection import has_receive_threads, kill, processes_of, receive_threads_of
from support.processes.platforms import environment, leftovers, unique_platform
from support.processes.program import Program
from support.processes.running_time import RunningTime

CLUSTERS = 2
CROWD = 8  # nodes at a time besides the lasting ones
ROUND_S = 60.0
LOOK_S = 5.0
BIRTH_S = 0.1
BURST_S = 10.0
RECEIVE_THREAD_LIFE_S = 20.0
LEAVING = 0.3  # share of the nodes that end by themselves; the others are killed
# On a busy machine they have thousands of messages left to take, at a few hundred a second.
DRAINING_S = 300.0
FEW_MESSAGES = 20
RESTING_BYTES = 4 << 20  # of SMEM: four times what the lasting nodes hold
STOPPED = 0.1  # share of the killed that hang for a while before


class Soak:
    """The platform, the lasting nodes and the temporary ones."""

    def __init__(self, start: Callable[..., Program], platform: str, clock: RunningTime) -> None:
        self._platform = platform
        self._load = Load(start, clock)
        self._bursts = start(peer_command(publish_bursts), 2)
        self._bursts.wait_for("bursting")
        self._nursery = start(peer_command(breed_actors))
        self._nursery.wait_for("ready")
        self._alive: list[int] = []
        self._leaving: list[int] = []
        self.lives = 0
        self.kills = 0
        self.killed_receive_threads = 0

    @property
    def lasting(self) -> list[int]:
        stay = (self._load.publisher, *self._load.checkers, self._bursts)
        return [program.pid for program in stay]

    def churn(self, look_at: Callable[[], None]) -> None:
        """Start and end nodes for a round."""
        end_s = time.monotonic() + ROUND_S
        next_s = dict.fromkeys((look_at, self._burst, self._kill_a_receive_thread), 0.0)
        every_s = {
            look_at: LOOK_S,
            self._burst: BURST_S,
            self._kill_a_receive_thread: RECEIVE_THREAD_LIFE_S,
        }
        while (now_s := time.monotonic()) < end_s:
            for action, due_s in next_s.items():
                if due_s <= now_s:
                    action()
                    next_s[action] = now_s + every_s[action]
            self._bear()
            while len(self._alive) > CROWD:
                self._end(self._alive.pop(random.randrange(len(self._alive))))
            time.sleep(random.uniform(0, 2 * BIRTH_S))

    def rest(self) -> Holdings:
        """End all temporary nodes, and return what is held by the lasting ones."""
        # Python ignores a SIGINT that arrives in a destructor, so leaving nodes are killed, too.
        for pid in (*self._alive, *self._leaving):
            self._kill(pid)
        self._alive.clear()
        self._leaving.clear()
        self._load.wait_until_it_goes_on()
        wait_until(lambda: has_receive_threads(self._platform), "each cluster has a receive thread")
        try:
            wait_until(self._is_at_rest, "only the nodes that stay are left")
        except AssertionError:
            raise AssertionError(self._left()) from None
        wait_until(
            lambda: max(self._queued()) < FEW_MESSAGES,
            "the lasting subscriptions have taken what the gone nodes published",
            DRAINING_S,
        )
        self._renew_publishers()
        try:
            wait_until(self._is_freed, "what the gone nodes held is freed")
        except AssertionError as error:
            raise AssertionError(f"{error}; queued: {self._queued()}") from None
        self._load.assert_in_order()
        # On a busy machine the queues of the checking nodes may overflow; missing messages are
        # counted.
        assert self._load.missing() <= self._lost()
        assert "torn" not in self._nursery.output, self._nursery
        return look(self._platform, self.lasting)

    def _renew_publishers(self) -> None:
        """Let go of topic DSMs that grew beside slow readers, and shrink minutes later."""
        for publisher in (self._bursts, self._load.publisher):
            publisher.say(RENEW)
            publisher.wait_for("renewed")
        self._load.wait_until_it_goes_on()

    def _is_at_rest(self) -> bool:
        held = look(self._platform, self.lasting)
        return held.process_slots == held.nodes == len(self.lasting)

    def _is_freed(self) -> bool:
        return look(self._platform, self.lasting).smem_used_bytes < RESTING_BYTES

    def _queued(self) -> list[int]:
        """Return how many messages each subscription has not taken."""
        with Platform(self._platform) as seen:
            sample = take_sample(seen, read_graph(seen), {})
        queued: list[int] = sample.counts[~sample.graph.is_publisher, QUEUED].tolist()
        return queued

    def _lost(self) -> int:
        with Platform(self._platform) as seen:
            return sum(endpoint.counters.lost for endpoint in seen.endpoints())

    def _left(self) -> str:
        with Platform(self._platform) as seen:
            nodes = [f"{node.namespace}{node.name} ({node.process})" for node in seen.nodes()]
            processes = [
                f"{process.slot}: {process.pid} {'alive' if process.alive else 'dead'}"
                for process in seen.processes()
            ]
        return f"more than {self.lasting} are left: {nodes}, {processes}\n{self._nursery}"

    def _bear(self) -> None:
        kind = random.choice(list(ACTORS))
        self._nursery.say(f"{kind} {random.randint(1, CLUSTERS)}")
        self._alive.append(int(self._nursery.wait_for(r"born (\d+)").group(1)))
        self.lives += 1

    def _end(self, pid: int) -> None:
        if random.random() < LEAVING:
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGINT)
            self._leaving.append(pid)
            return
        if random.random() < STOPPED:
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGSTOP)
            time.sleep(BIRTH_S)  # a while in which it hangs
        self._kill(pid)

    def _kill(self, pid: int) -> None:
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
            self.kills += 1

    def _burst(self) -> None:
        self._bursts.say("burst")

    def _kill_a_receive_thread(self) -> None:
        if threads := receive_threads_of(self._platform):
            kill(random.choice(threads))
            self.killed_receive_threads += 1


@contextmanager
def programs_on(platform: str) -> Iterator[Callable[..., Program]]:
    """Yield a function that starts programs on a platform; they end with this block."""
    programs: list[Program] = []
    servers = PeerServers()

    def start(command: list[str], cluster: int = 1) -> Program:
        env = environment(platform, cluster)
        servers.serve(command, env)
        programs.append(Program(command, env))
        return programs[-1]

    try:
        yield start
    finally:
        for program in programs:
            program.kill()
        for pid in processes_of(platform):
            kill(pid)
        servers.end()


def soak(hours: float, record: Record) -> None:
    """Soak a new platform, and write what it holds into the record."""
    platform = unique_platform()
    clock = RunningTime()
    start_s = time.monotonic()
    with programs_on(platform) as start:
        soaked = Soak(start, platform, clock)

        def note(at_rest: bool, holdings: Holdings) -> None:
            record.add(time.monotonic() - start_s, at_rest, holdings)

        while time.monotonic() - start_s < hours * 3600:
            soaked.churn(lambda: note(False, look(platform, soaked.lasting)))
            rest = soaked.rest()
            note(True, rest)
            print(
                f"{(time.monotonic() - start_s) / 60:6.1f} min: {soaked.lives} lives, "
                f"{soaked.kills} kills, {soaked.killed_receive_threads} of receive threads; {rest}",
                flush=True,
            )
    clock.stop()
    wait_until(lambda: not leftovers(platform), f"{platform} leaves nothing in /dev/shm")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--hours", type=float, default=1.0)
    parser.add_argument("--output", type=Path, default=Path("build/soak"))
    parser.add_argument("--seed", type=int, default=random.randrange(1 << 32))
    options = parser.parse_args()
    random.seed(options.seed)
    print(f"seed {options.seed}", flush=True)
    record = Record(options.output)
    try:
        soak(options.hours, record)
    finally:
        print(f"see {record.draw()}")
    found = grown(record.rests())
    print("\n".join(found) or "nothing grew")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
