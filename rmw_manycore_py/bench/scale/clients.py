# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mutual cost of the clients of a service, and of an action."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial

from rmw_manycore_py.bench.contenders import FAST_DDS, Middleware
from rmw_manycore_py.bench.idle import cpu_ns, wait_until_quiet, wake_ups
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.scale.common import CLUSTERS, OWN, along, at_count, on_curve
from rmw_manycore_py.bench.session import Process, Session
from rmw_manycore_py.bench.summary import Goal, Result

IDLE_PROCESSES = 4
TURNS = 5
ONE_INSTEAD = ", with 1 client instead"


@dataclass(frozen=True)
class Served:
    """A service or action, with this many clients.

    :param start: starts a role as a party, with the arguments of the role.
    """

    question: str
    woken: str
    cpu: str
    clients: Sequence[int]
    warm_up: int
    calls: int
    start: Callable[..., Process]


def _start_service(session: Session, party: int, role: str, *numbers: int) -> Process:
    words = {"idle": ("clients",), "caller": ("warm_up", "iterations")}.get(role, ())
    arguments = dict(zip(words, numbers, strict=True))
    return session.native("clients", party, role=role, **arguments)


def _start_action(session: Session, party: int, role: str, *numbers: int) -> Process:
    return session.python("actions", party, role, *numbers)


SERVICE = Served(
    "a call to a service with as many clients",
    "sleeps of a service's other clients per call",
    "CPU time of a service's other clients per call",
    (1, 25, 50, 100, 200),
    50,
    1000,
    _start_service,
)
ACTION = Served(
    "a goal of an action with as many clients, in rclpy",
    "sleeps of an action's other clients per goal",
    "CPU time of an action's other clients per goal",
    (1, 10, 25, 50),
    5,
    50,
    _start_action,
)


def measure(run: Run) -> list[Result]:
    """Return the time of a call and its cost for other clients, over the clients."""
    results: list[Result] = []
    for served, middleware, call in (
        (SERVICE, OWN, _call_in_turns),
        (SERVICE, FAST_DDS, _call),
        (ACTION, OWN, _call),
        (ACTION, FAST_DDS, _call),
    ):
        contender = f"{served.question}: {middleware.name}"
        measured = partial(call, run, _apart(middleware), served)
        results += along(run, contender, served.clients, "clients", measured)
    return results


def _apart(middleware: Middleware) -> Middleware:
    """Put server and caller into two clusters, the other clients into the rest."""
    if not middleware.is_manycore:
        return middleware
    others = (i % (CLUSTERS - 2) + 3 for i in range(IDLE_PROCESSES))
    return replace(middleware, clusters=(1, 2, *others))


@dataclass
class Attended:
    """A server with clients that wait, and what the calls of further ones took so far.

    What the waiting clients spend includes the start and the end of those that call.
    """

    session: Session
    served: Served
    waiting: Sequence[Process]
    samples_us: list[float] = field(default_factory=list)
    used_ns: int = 0
    woken: int = 0
    calls: int = 0

    def call(self, calls: int) -> None:
        """Have a new client call."""
        pids = [process.pid for process in self.waiting]
        wait_until_quiet(pids)
        before_ns, before = cpu_ns(pids), wake_ups(pids)
        caller = self.served.start(self.session, 1, "caller", self.served.warm_up, calls)
        self.samples_us += in_us(caller.finish()["samples_ns"])
        self.used_ns += cpu_ns(pids) - before_ns
        self.woken += wake_ups(pids) - before
        self.calls += self.served.warm_up + calls


@contextmanager
def _attended(run: Run, middleware: Middleware, served: Served, clients: int) -> Iterator[Attended]:
    """Start a server, and all clients but the one that calls."""
    with Session(middleware, run.cpus) as session:
        server = served.start(session, 0, "server")
        server.wait_until_ready()
        waiting = [
            served.start(session, party, "idle", share)
            for party, share in enumerate(_shares(clients - 1), start=2)
        ]
        for process in waiting:
            process.wait_until_ready()
        session.receive_thread_pids()  # one that is still starting would wake the clients
        yield Attended(session, served, waiting)
        for process in (server, *waiting):
            process.release()
            process.finish()


def _call(run: Run, middleware: Middleware, served: Served, clients: int) -> list[Result]:
    with _attended(run, middleware, served, clients) as attended:
        attended.call(run.iterations(served.calls))
    return _found(middleware, attended, clients)


def _call_in_turns(run: Run, middleware: Middleware, served: Served, clients: int) -> list[Result]:
    """Call a server of `clients` clients, and one of a single client, in turns."""
    calls = run.iterations(served.calls // TURNS)
    with (
        _attended(run, middleware, served, clients) as of_all,
        _attended(run, middleware, served, 1) as of_one,
    ):
        for _ in range(TURNS):
            of_all.call(calls)
            of_one.call(calls)
    one, samples_us = middleware.name + ONE_INSTEAD, of_one.samples_us
    return [
        *_found(middleware, of_all, clients),
        on_curve(served.question, one, clients, "clients", "us", samples_us),
    ]


def _found(middleware: Middleware, attended: Attended, clients: int) -> list[Result]:
    served, calls = attended.served, attended.calls
    return [
        on_curve(question, middleware.name, clients, "clients", unit, samples)
        for question, unit, samples in (
            (served.question, "us", attended.samples_us),
            (served.woken, "count", [attended.woken / calls]),
            (served.cpu, "us", [attended.used_ns / 1e3 / calls]),
        )
    ]


def _shares(clients: int) -> list[int]:
    """Return the number of clients of each idle process."""
    shares = [len(range(i, clients, IDLE_PROCESSES)) for i in range(IDLE_PROCESSES)]
    return [share for share in shares if share > 0]


def _at(middleware: Middleware, served: Served, place: int) -> str:
    return at_count(middleware.name, served.clients[place], "clients")


GOALS = (
    Goal(
        SERVICE.question,
        _at(OWN, SERVICE, -1),
        "within",
        1.2,
        at_count(OWN.name + ONE_INSTEAD, SERVICE.clients[-1], "clients"),
    ),
    Goal(SERVICE.woken, _at(OWN, SERVICE, -1), "within", 0.1),
    # Status and feedback of an action are sent to all of its clients.
    Goal(ACTION.question, _at(OWN, ACTION, -1), "better", 1.0, _at(FAST_DDS, ACTION, -1)),
    Goal(ACTION.cpu, _at(OWN, ACTION, -1), "better", 1.0, _at(FAST_DDS, ACTION, -1)),
)
PLACEMENT = "clients: server on the first, caller on the second, the others on both in turn"
