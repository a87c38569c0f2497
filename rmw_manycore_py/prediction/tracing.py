# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A simulated run as a trace, which opens wherever the trace of a real one does."""

from __future__ import annotations

from collections.abc import Iterator

from rmw_manycore_py.prediction.events import EventLog
from rmw_manycore_py.prediction.simulation import Placed, Simulation
from rmw_manycore_py.trace.events import Endpoint, EndpointId, Process, Thread, Trace

PLATFORM = "simulated"
_FIRST_PID, _FIRST_RECEIVE_PID = 1001, 901
_UNKNOWN_TYPE = ""


def trace_of(simulation: Simulation) -> Trace:
    """Return the events of a simulation that has run with its events recorded."""
    return Trace(
        PLATFORM,
        (*_receive_threads(simulation), *_processes(simulation)),
        dict(_endpoints(simulation)),
        0,
    )


def _processes(simulation: Simulation) -> Iterator[Process]:
    pid = _FIRST_PID
    for placed in simulation.processes:
        yield _process(placed, pid)
        pid += 1 + len(placed.threads)


def _process(placed: Placed, pid: int) -> Process:
    core, host_cpus = placed.site.core, placed.site.host_cpus
    logs = [(placed.label, placed.other), *((placed.label, log) for _, log in placed.threads)]
    return Process(
        pid=pid,
        cluster=core.cluster,
        core=core.core,
        host_cpu=host_cpus[0] if len(host_cpus) == 1 else None,
        label=placed.label,
        is_receive_thread=False,
        is_alive=True,
        threads=tuple(_threads(pid, logs)),
        unplaced=0,
    )


def _threads(pid: int, logs: list[tuple[str, EventLog]]) -> Iterator[Thread]:
    for offset, (name, log) in enumerate(logs):
        if log.rows:
            yield Thread(pid + offset, name[:15], log.events(), 0)


def _receive_threads(simulation: Simulation) -> Iterator[Process]:
    for cluster, thread in sorted(simulation.receive_threads.items()):
        pid = _FIRST_RECEIVE_PID + cluster
        label = f"receive thread {cluster}"
        threads = tuple(_threads(pid, [(label, thread.log)]))
        yield Process(pid, cluster, None, None, label, True, True, threads, 0)


def _endpoints(simulation: Simulation) -> Iterator[tuple[EndpointId, Endpoint]]:
    for one in simulation.all_publishers:
        yield (
            one.endpoint,
            Endpoint(True, "topic", one.topic, _UNKNOWN_TYPE, one.node, one.cluster),
        )
    for work in simulation.works.values():
        sub = work.subscription
        if sub is not None:
            yield (
                sub.endpoint,
                Endpoint(False, "topic", sub.topic, _UNKNOWN_TYPE, sub.node, sub.cluster),
            )
