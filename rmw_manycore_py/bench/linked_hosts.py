# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One platform over two hosts, beside plain zenoh and Fast DDS over the same shaped link."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import replace
from functools import partial

from rmw_manycore_program import own_program
from rmw_manycore_py.bench.bridging import bridge_command
from rmw_manycore_py.bench.contenders import BETWEEN, FAST_DDS, Middleware
from rmw_manycore_py.bench.hosts import ADDRESSES, NETWORK, Host, can_have_hosts, two_hosts
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
IN_FLIGHT, STRETCH, STRETCHES = 8, 40, 5
HOSTS = ("a", "b")
PORT = 7451


class Node:
    """A host of a measurement: starts nodes there."""

    def __init__(self, session: Session, host: Host, party: int) -> None:
        self._session, self._host, self._party = session, host, party

    def start(self, module: str, *arguments: object) -> Process:
        """Start a node of the benches."""
        command = own_program(f"{NODES}.{module}", *map(str, arguments))
        return self._session.start([*self._host, *command], self._party)


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
    return [*(one for size in SIZES for one in _round_trips(run, size)), *_throughput(run)]


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
    return rates + [
        Result(f"{THROUGHPUT}, lost", name, "messages", tuple(counts))
        for name, counts in lost.items()
    ]


QUESTION = Question(
    "hosts",
    measure,
    (
        Goal("round trip 64 B", LINKED, "within", 1.3, SUM),
        Goal(THROUGHPUT, LINKED, "better", 1.0, FAST_DDS.name),
        Goal(f"{THROUGHPUT}, lost", LINKED, "within", 0, statistic="largest"),
    ),
    f"hosts are network namespaces joined by a cable of {RATE}; ping on the first CPU, pong on the "
    "second, links on either",
)
