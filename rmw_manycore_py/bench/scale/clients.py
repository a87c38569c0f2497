# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the clients of a service cost each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rmw_manycore_py.bench.contenders import FAST_DDS, Middleware
from rmw_manycore_py.bench.idle import cpu_ns, wait_until_quiet, wake_ups
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.round_trip import in_us
from rmw_manycore_py.bench.scale.common import CLUSTERS, OWN, at_count, drawn, on_curve
from rmw_manycore_py.bench.session import Session
from rmw_manycore_py.bench.summary import Goal, Result

CALL = "a call to a service with as many clients"
WOKEN = "sleeps of its other clients per call"
CPU = "CPU time of its other clients per call"
CLIENTS = (1, 25, 50, 100, 200)
IDLE_PROCESSES = 4
WARM_UP, CALLS = 50, 1000


def measure(run: Run) -> list[Result]:
    """Return what a call takes, and what it costs the others, over the clients."""
    results: list[Result] = []
    for middleware in (OWN, FAST_DDS):
        for count in drawn(run, CLIENTS):
            if run.wants(f"{CALL}: {middleware.name}"):
                run.note(f"{count} clients: {middleware.name}")
                results += _call(run, _apart(middleware), count)
    return results


def _apart(middleware: Middleware) -> Middleware:
    """Put server and caller into two clusters, the other clients into the rest."""
    if not middleware.is_manycore:
        return middleware
    others = (i % (CLUSTERS - 2) + 3 for i in range(IDLE_PROCESSES))
    return replace(middleware, clusters=(1, 2, *others))


def _call(run: Run, middleware: Middleware, clients: int) -> list[Result]:
    def found(question: str, unit: str, samples: Sequence[float]) -> Result:
        return on_curve(question, middleware.name, clients, "clients", unit, samples)

    calls = run.iterations(CALLS)
    with Session(middleware, run.cpus) as session:
        server = session.native("clients", 0, role="server")
        server.wait_until_ready()
        idle = [
            session.native("clients", party, role="idle", clients=share)
            for party, share in enumerate(_shares(clients - 1), start=2)
        ]
        for process in idle:
            process.wait_until_ready()
        pids = [process.pid for process in idle]
        wait_until_quiet(pids)
        caller = session.native("clients", 1, role="caller", warm_up=WARM_UP, iterations=calls)
        before_ns, before = cpu_ns(pids), wake_ups(pids)
        samples_ns = caller.finish()["samples_ns"]
        used_ns, woken = cpu_ns(pids) - before_ns, wake_ups(pids) - before
        for process in (server, *idle):
            process.release()
            process.finish()
    of_all = WARM_UP + calls  # and of the caller's coming and going
    return [
        found(CALL, "us", in_us(samples_ns)),
        found(WOKEN, "count", [woken / of_all]),
        found(CPU, "us", [used_ns / 1e3 / of_all]),
    ]


def _shares(clients: int) -> list[int]:
    """Return how many clients each idle process has."""
    shares = [len(range(i, clients, IDLE_PROCESSES)) for i in range(IDLE_PROCESSES)]
    return [share for share in shares if share > 0]


_most, _one = (at_count(OWN.name, count, "clients") for count in (CLIENTS[-1], CLIENTS[0]))
GOALS = (
    Goal(CALL, _most, "within", 1.2, _one),
    Goal(WOKEN, _most, "within", 0.1),
)
PLACEMENT = "clients: server on the first, caller on the second, the others on both in turn"
