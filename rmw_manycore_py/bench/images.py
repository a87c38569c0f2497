# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Images sent to another host through the bridge or by Fast DDS alone, under load."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, replace
from functools import partial

from rmw_manycore_program import own_program
from rmw_manycore_py.bench.bridging import bridge_command
from rmw_manycore_py.bench.contenders import BETWEEN, FAST_DDS, MIB, Middleware
from rmw_manycore_py.bench.hosts import NETWORK, Host, can_have_hosts, two_hosts
from rmw_manycore_py.bench.load import busy
from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.session import NODES, TIMEOUT_S, Session
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.routes.route import Route

NAME = "images of 1 MiB at 30 Hz that reach another host"
BRIDGED = "bridged"
RATE_HZ, IMAGES = 30, 150
TYPE = "std_msgs/msg/UInt8MultiArray"
RELIABILITIES = ("reliable", "best_effort")


@dataclass(frozen=True)
class Load:
    """Endless processes on the CPU of the camera or on both."""

    name: str
    processes: int
    on_both: bool


LOADS = (
    Load("free CPUs", 0, True),
    Load("6 loops on the camera's CPU", 6, False),
    Load("30 loops", 30, True),
)


def measure(run: Run) -> list[Result]:
    """Return how many of a hundred images arrive; empty if hosts cannot be emulated."""
    if not can_have_hosts():
        run.note(f"{NAME}: left out, as network namespaces need root and ip")
        return []
    results = []
    for load in LOADS:
        for reliability in RELIABILITIES:
            contenders = {
                BRIDGED: partial(_watch, run, load, reliability, is_bridged=True),
                FAST_DDS.name: partial(_watch, run, load, reliability, is_bridged=False),
            }
            name = question(reliability, load)
            results += run.interleave(name, "%", contenders, higher_is_better=True)
    return results


def question(reliability: str, load: Load) -> str:
    """Return the name of a question."""
    return f"{NAME}, {reliability.replace('_', ' ')}, {load.name}"


def _watch(run: Run, load: Load, reliability: str, *, is_bridged: bool) -> list[float]:
    with ExitStack() as ending:
        here, there = ending.enter_context(two_hosts())
        outside = inside = ending.enter_context(Session(_networked(FAST_DDS), run.cpus))
        if is_bridged:
            inside = ending.enter_context(Session(_networked(BETWEEN), run.cpus))
            _start_bridge(run, here, inside, outside)
        images = run.iterations(IMAGES)
        counter = outside.start([*there, *_camera(reliability, "count", images)], 1)
        camera = inside.start([*here, *_camera(reliability, MIB, RATE_HZ, images)], 0)
        counter.wait_until_ready()
        on = run.cpus if load.on_both else run.cpus[:1]
        with busy(load.processes, on, TIMEOUT_S):
            camera.release()
            camera.wait_until_ready()
            counter.release()  # it still awaits the images in flight
            return [100.0 * counter.finish()["images"] / images]


def _networked(middleware: Middleware) -> Middleware:
    return replace(middleware, variables={**middleware.variables, **NETWORK})


def _camera(*words: object) -> tuple[str, ...]:
    return own_program(f"{NODES}.camera", *map(str, words))


def _start_bridge(run: Run, here: Host, inside: Session, outside: Session) -> None:
    route = Route("topic", "outward", "/images", "/images", TYPE, outside.domain)
    command = bridge_command(inside, [route], "outward")
    outside.start([*here, *command], 0, cpus=run.cpus)  # not pinned, as under `manycore run`


GOALS = tuple(
    Goal(question(reliability, load), BRIDGED, "better", 1.0, FAST_DDS.name)
    for load in LOADS
    for reliability in RELIABILITIES
)
PLACEMENT = "images: camera on the first, what counts them on the second, the bridge on either"
