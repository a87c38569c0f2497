# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Cost of `manycore view`, and its latency."""

from __future__ import annotations

import os
import shutil
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

from rmw_manycore_program import own_program
from rmw_manycore_py.bench.contenders import manycore
from rmw_manycore_py.bench.idle import cpu_ns
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.session import TIMEOUT_S, Process, Session
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.errors import ManycoreError

FIRST = "first picture, from the start of the command"
COST = "CPU time of the viewer, at two looks a second"
FRAME = "a frame in headless Chromium, until it is painted"
RED = "until a killed node is red"

NODES = (50, 500)
TOPICS_OF_A_NODE = 2
MESSAGE_PERIOD_MS = 500
CLUSTERS = 5
WINDOW_S = 20.0
FRAMES = 20
KILLED = 5
_LOOK_AGAIN_S = 0.005


def measure(run: Run) -> list[Result]:
    """Return the cost of a viewer and its page, over the number of nodes."""
    results: list[Result] = []
    for count in NODES[:1] if run.share < 1 else NODES:
        if run.wants(f"{COST}: {_name(count)}"):
            results += _watch(run, count)
    return results


def _name(nodes: int) -> str:
    return f"{nodes} nodes, {TOPICS_OF_A_NODE * nodes} topics"


def _watch(run: Run, count: int) -> list[Result]:
    def found(question: str, unit: str, *samples: float) -> Result:
        return Result(question, _name(count), unit, samples)

    spread = tuple(i % CLUSTERS + 1 for i in range(count))
    middleware = replace(manycore("inside"), clusters=spread)
    with Session(middleware, run.cpus) as session, _browser() as page:
        run.note(f"{_name(count)}: starting them")
        nodes = [
            session.native("fleet", i, first=i, nodes=1, all=count, period_ms=MESSAGE_PERIOD_MS)
            for i in range(count)
        ]
        for node in nodes:
            node.wait_until_ready()
        run.note(f"{_name(count)}: watching them")
        viewer, first_ms = _open(session, page)
        try:
            viewer_pid = viewer.pid
            before_ns, start_s = cpu_ns([viewer_pid]), time.monotonic()
            frames = _frames_ms(page, max(run.iterations(FRAMES), 5))
            time.sleep(WINDOW_S * max(run.share, 0.2))
            spent_ms = (cpu_ns([viewer_pid]) - before_ns) / 1e6
            cost = spent_ms / (time.monotonic() - start_s)
            reds = [_red_ms(page, nodes[i], f"/fleet_{i}") for i in range(KILLED)]
        finally:
            viewer.close()
    return [
        found(FIRST, "ms", first_ms),
        found(COST, "ms/s", cost),
        found(FRAME, "ms", *frames),
        found(RED, "ms", *reds),
    ]


def _open(session: Session, page: Any) -> tuple[Process, float]:
    """Start a viewer and open its page; return the ms until the first picture."""
    command = own_program(
        *("rmw_manycore_py.cli", "view", "--port", "0", "--platform", session.platform)
    )
    viewer = Process("manycore view", command, dict(os.environ), sorted(os.sched_getaffinity(0)))
    page.get(viewer.next_line().split()[-1])
    _wait(lambda: page.execute_script("return document.querySelector('[data-node]') !== null"))
    return viewer, (time.monotonic_ns() - viewer.started_ns) / 1e6


def _frames_ms(page: Any, count: int) -> list[float]:
    """Return the durations of the next frames in ms, as measured by the page."""
    frames: list[float] = []
    seen = None
    while len(frames) < count:
        script = "return [document.body.dataset.frames, document.body.dataset.frameMs]"
        number, taken_ms = page.execute_script(script)
        if number != seen and taken_ms is not None:
            frames.append(float(taken_ms))
            seen = number
        time.sleep(0.1)
    return frames


def _red_ms(page: Any, node: Process, name: str) -> float:
    start_ns = time.monotonic_ns()
    os.kill(node.pid, signal.SIGKILL)
    selector = f"g.dead[data-node='{name}']"
    _wait(lambda: page.execute_script(f'return document.querySelector("{selector}") !== null'))
    return (time.monotonic_ns() - start_ns) / 1e6


def _wait(condition: Callable[[], bool]) -> None:
    deadline_s = time.monotonic() + TIMEOUT_S
    while not condition():
        if time.monotonic() > deadline_s:
            raise ManycoreError(f"the page of manycore view shows nothing within {TIMEOUT_S:g} s")
        time.sleep(_LOOK_AGAIN_S)


@contextmanager
def _browser() -> Iterator[Any]:
    """Yield headless Chromium."""
    try:
        from selenium import webdriver
    except ImportError as error:
        raise ManycoreError(f"no browser ({error}): pip install selenium") from error
    programs = [shutil.which(name) for name in ("chromium", "chromedriver")]
    if not all(programs):
        raise ManycoreError("no browser: apt-get install chromium chromium-driver")
    options = webdriver.ChromeOptions()
    options.binary_location = programs[0]
    for argument in ("--headless=new", "--window-size=1500,900", "--disable-dev-shm-usage"):
        options.add_argument(argument)
    if os.geteuid() == 0:
        options.add_argument("--no-sandbox")
    driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(programs[1]))
    try:
        yield driver
    finally:
        driver.quit()


_MOST = _name(NODES[-1])
QUESTION = Question(
    "view",
    measure,
    (
        Goal(FIRST, _MOST, "within", 1000),
        Goal(COST, _MOST, "within", 30),
        Goal(FRAME, _MOST, "within", 150),
        Goal(RED, _MOST, "within", 1000),
    ),
    f"nodes: on both in turn, over {CLUSTERS} clusters; viewer and browser: where they like",
)
