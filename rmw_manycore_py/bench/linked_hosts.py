# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One platform over two hosts, beside plain zenoh and Fast DDS over the same shaped link."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, closing, contextmanager
from dataclasses import replace
from functools import partial

from rmw_manycore_program import own_program
from rmw_manycore_py.bench.bridging import bridge_command
from rmw_manycore_py.bench.contenders import BETWEEN, FAST_DDS, Middleware
from rmw_manycore_py.bench.hosts import ADDRESSES, NETWORK, Host, can_have_hosts, two_hosts
from rmw_manycore_py.bench.link_upkeep import Beat, set_cable, traffic_bytes
from rmw_manycore_py.bench.question import PAYLOADS, Question, Run
from rmw_manycore_py.bench.rclpy_round_trip import WARM_UP, iterations
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.session import NODES, Process, Session
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.routes.hosts import host_routes
from rmw_manycore_py.routes.outside import OutsideSettings
from rmw_manycore_py.routes.route import DIRECTIONS

RATE = "1gbit"
LINKED, ZENOH = "two hosts", "plain zenoh"
SUM = "plain zenoh + 2 platforms"
SIZES = ("64 B", "1 MiB")
THROUGHPUT = "throughput 1 MiB over 1 Gbit/s"
CABLE_RATE = "the cable"
CABLE_PER_S = 1e9 / 8 / PAYLOADS["1 MiB"]
IDLE, RESUMED, UNCOUNTED = "idle traffic", "flow after a break of 30 s", "uncounted after a break"
IDLE_S, BREAK_S, SETTLE_S = 30, 30, 2
IN_FLIGHT, STRETCH, STRETCHES = 8, 40, 5
HOSTS = ("a", "b")
PORT = 7451


class Node:
    """A host of a measurement: starts nodes there."""

    def __init__(self, session: Session, host: Host, party: int) -> None:
        self._session, self.host, self._party = session, host, party

    @property
    def platform(self) -> str:
        """Name of its platform."""
        return self._session.platform

    def start(self, module: str, *arguments: object) -> Process:
        """Start a node of the benches."""
        command = own_program(f"{NODES}.{module}", *map(str, arguments))
        return self._session.start([*self.host, *command], self._party)


Hosts = Callable[[Run], AbstractContextManager[tuple[Node, Node]]]


@contextmanager
def dds_hosts(run: Run) -> Iterator[tuple[Node, Node]]:
    """Two hosts that Fast DDS joins."""
    with two_hosts(RATE) as (here, there), Session(_networked(FAST_DDS), run.cpus) as session:
        yield Node(session, here, 0), Node(session, there, 1)


@contextmanager
def linked_hosts(run: Run) -> Iterator[tuple[Node, Node]]:
    """Two hosts, each with a part of the platform and the processes of its links."""
    addresses = {
        name: f"tcp/{address}:{PORT}" for name, address in zip(HOSTS, ADDRESSES, strict=True)
    }
    with ExitStack() as ending:
        both = ending.enter_context(two_hosts(RATE))
        nodes = []
        for party, (name, host) in enumerate(zip(HOSTS, both, strict=True)):
            session = ending.enter_context(Session(BETWEEN, run.cpus))
            others = [address for other, address in addresses.items() if other != name]
            outside = OutsideSettings("hosts", tuple(others), addresses[name], name)
            for core, direction in enumerate(DIRECTIONS, 2):
                command = bridge_command(session, host_routes(direction), direction, core, outside)
                session.start([*host, *command], party, cpus=run.cpus)
            nodes.append(Node(session, host, party))
        yield nodes[0], nodes[1]


@contextmanager
def beating(run: Run) -> Iterator[tuple[Node, Beat]]:
    """Linked hosts, and messages from the first, which is returned too, to the other."""
    with linked_hosts(run) as (here, there), closing(Beat(here.platform, there.platform)) as beat:
        yield here, beat


@contextmanager
def one_platform(run: Run) -> Iterator[tuple[Node, Node]]:
    """No link: one platform on one host."""
    with Session(BETWEEN, run.cpus) as session:
        yield Node(session, [], 0), Node(session, [], 1)


def _networked(middleware: Middleware) -> Middleware:
    return replace(middleware, variables={**middleware.variables, **NETWORK})


def measure(run: Run) -> list[Result]:
    """Measure round trips, then throughput."""
    if not can_have_hosts():
        raise ManycoreError("bench hosts: network namespaces need root and ip(8)")
    round_trips = [one for size in SIZES for one in _round_trips(run, size)]
    return [*round_trips, *_throughput(run), *_upkeep(run)]


def _round_trips(run: Run, size: str) -> list[Result]:
    messages = run.iterations(iterations(PAYLOADS[size]))
    arguments = (PAYLOADS[size], WARM_UP, messages)
    question = f"round trip {size}"
    contenders = {
        LINKED: partial(_talk, run, linked_hosts, arguments),
        FAST_DDS.name: partial(_talk, run, dds_hosts, arguments),
        ZENOH: partial(_talk_zenoh, run, arguments),
        BETWEEN.name: partial(_talk, run, one_platform, arguments),
    }
    results = run.interleave(question, "us", contenders)
    medians = {result.contender: result.summary.median for result in results}
    if ZENOH in medians and BETWEEN.name in medians:
        total = medians[ZENOH] + 2 * medians[BETWEEN.name]
        results.append(Result(question, SUM, "us", (total,)))
    return results


def _talk(run: Run, hosts: Hosts, arguments: Sequence[int]) -> list[float]:
    with hosts(run) as (here, there):
        return _samples(there.start("pong"), here.start("ping", *arguments))


def _talk_zenoh(run: Run, arguments: Sequence[int]) -> list[float]:
    with dds_hosts(run) as (here, there):
        locator = f"tcp/{ADDRESSES[1]}:{PORT}"
        pong = there.start("zenoh_echo", "pong", locator)
        return _samples(pong, here.start("zenoh_echo", "ping", locator, *arguments))


def _samples(pong: Process, ping: Process) -> list[float]:
    found = ping.finish()
    pong.finish()
    return in_us(found["samples_ns"])


def _throughput(run: Run) -> list[Result]:
    lost: dict[str, list[float]] = {}

    def flood(name: str, hosts: Hosts) -> list[float]:
        stretch, stretches = run.iterations(STRETCH), run.iterations(STRETCHES)
        sizes = (PAYLOADS["1 MiB"], IN_FLIGHT, stretch, stretch, stretches)
        with hosts(run) as (here, there):
            sink = there.start("sink", "/ping", "/pong", IN_FLIGHT)
            found = here.start("source", "/ping", "/pong", *sizes).finish()
            lost.setdefault(name, []).append(sink.finish()["lost"])
        return [stretch / sample_ns * 1e9 for sample_ns in found["samples_ns"]]

    contenders = {
        LINKED: partial(flood, LINKED, linked_hosts),
        FAST_DDS.name: partial(flood, FAST_DDS.name, dds_hosts),
    }
    rates = run.interleave(THROUGHPUT, "1/s", contenders, higher_is_better=True)
    if rates:
        rates.append(Result(THROUGHPUT, CABLE_RATE, "1/s", (CABLE_PER_S,), higher_is_better=True))
    return rates + [
        Result(f"{THROUGHPUT}, lost", name, "messages", tuple(counts))
        for name, counts in lost.items()
    ]


def _upkeep(run: Run) -> list[Result]:
    """Measure the link when nothing crosses it, and when it comes back."""
    uncounted: list[float] = []

    def idle() -> list[float]:
        idle_s = run.iterations(IDLE_S)
        with beating(run) as (here, beat):
            beat.until_heard()
            time.sleep(SETTLE_S)
            before = traffic_bytes(here.host)
            time.sleep(idle_s)
            return [(traffic_bytes(here.host) - before) / idle_s]

    def resumed() -> list[float]:
        with beating(run) as (here, beat):
            beat.until_heard()
            before = beat.uncounted()  # published before the other host subscribed
            set_cable(here.host, "down")
            beat.for_a_while(BREAK_S)
            set_cable(here.host, "up")
            took_s = beat.until_heard()
            uncounted.append(beat.uncounted() - before)
            return [took_s]

    results = run.interleave(IDLE, "bytes/s", {LINKED: idle})
    results += run.interleave(RESUMED, "s", {LINKED: resumed})
    return results + [Result(UNCOUNTED, LINKED, "messages", tuple(uncounted))] * bool(uncounted)


QUESTION = Question(
    "hosts",
    measure,
    (
        Goal("round trip 64 B", LINKED, "within", 1.3, SUM),
        Goal(THROUGHPUT, LINKED, "better", 1.0, FAST_DDS.name),
        Goal(THROUGHPUT, LINKED, "better", 0.9, CABLE_RATE),
        Goal(f"{THROUGHPUT}, lost", LINKED, "within", 0, statistic="largest"),
        Goal(IDLE, LINKED, "within", 300),
        Goal(RESUMED, LINKED, "within", 2, statistic="largest"),
        Goal(UNCOUNTED, LINKED, "within", 0, statistic="largest"),
    ),
    f"hosts are network namespaces joined by a cable of {RATE}; ping on the first CPU, pong on the "
    "second, links on either",
)
