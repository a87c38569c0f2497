# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs the reference system: starts its processes and collects their output."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from rmw_manycore_program import own_program
from rmw_manycore_py.bench.contenders import Middleware
from rmw_manycore_py.bench.idle import cpu_ns
from rmw_manycore_py.bench.session import TIMEOUT_S, Process, Session, native_command
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native._transport import Configurator, TopicConfiguration
from rmw_manycore_py.papers.reference_system.bench.graph import Member
from rmw_manycore_py.papers.reference_system.bench.text import Loss, Report, losses_in, reports_in
from rmw_manycore_py.process.scheduling import scheduled_as

Nodes = Literal["rcl", "rclpy"]
NATIVE = "reference_node"
MODULE = "rmw_manycore_py.papers.reference_system"
LAST = "VehicleDBWSystem"
# Delay after the first output, for one-time work of the processes.
SETTLED_AFTER_S = 3.0
POLL_PERIOD_S = 0.02
KEEP_ALL = 0
# Number of messages per topic DSM; each has a header as well.
KEPT_MESSAGES = 16
RECORD_BYTES = 128
US_PER_MS = 1e3
NS_PER_S = 1e9


@dataclass(frozen=True)
class Load:
    """Work of the nodes besides forwarding; a depth of 0 keeps all messages."""

    message: str
    payload: str = "untouched"
    crunch_ms: float = 0.0
    depth: int = 1
    report_period_ms: int = 0

    @property
    def message_bytes(self) -> int:
        """Size of a message, which its type is named after."""
        return int("".join(filter(str.isdigit, self.message))) * 1024


@dataclass(frozen=True)
class Found:
    """One run: external measurements, and the nodes' output in that time."""

    start_ms: float
    window_s: float
    cpu_ms_per_s: float
    pss_bytes: Sequence[int]  # per node; last: all receive threads together
    reports: Sequence[Report]
    losses: Sequence[Loss]
    text: str  # output of the command node at the end of the hot path


def run_system(
    nodes: Nodes,
    middleware: Middleware,
    system: Sequence[Member],
    load: Load,
    window_s: float,
) -> Found:
    """Start all nodes, measure for a time after the first output, stop them."""
    clusters = tuple(member.cluster for member in system)
    cpus = [member.host_cpu for member in system]
    timeout_s = TIMEOUT_S + window_s
    placed = replace(middleware, clusters=clusters)
    with ExitStack() as stack:
        directory = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        session = stack.enter_context(Session(placed, cpus, timeout_s))
        if middleware.is_manycore:
            stack.enter_context(_platform(session, system, load))
        started_ns = time.time_ns()
        processes = [
            _start(session, nodes, party, member, load, directory)
            for party, member in enumerate(system)
        ]
        first_ns = _first_output_ns(directory, processes)
        time.sleep(SETTLED_AFTER_S)
        with _measured([p.pid for p in processes], session) as outside:
            time.sleep(window_s)
            for process in processes:
                process.raise_if_failed()
        for process in processes:
            process.interrupt()
        for process in processes:
            process.finish()
        return _found(directory, first_ns - started_ns, outside)


def _platform(session: Session, system: Sequence[Member], load: Load) -> Configurator:
    """Create the platform, with topic DSMs of fixed size as set in a mapfile.

    Growing takes the registry lock, which a publisher may not get while 24 nodes start; and with
    KEEP_ALL it continues until the SMEM is full.
    """
    return Configurator(
        session.platform,
        clusters=max(member.cluster for member in system),
        cores_per_cluster=len(system) + 1,
        smem_bytes=0,
        host_cpu_of_receive_thread={},
        topics=[
            TopicConfiguration(
                f"/{topic}",
                id=number,
                dsm_size_bytes=KEPT_MESSAGES * (load.message_bytes + RECORD_BYTES),
                receiver_clusters=sum({1 << (m.cluster - 1) for m in system if topic in m.inputs}),
            )
            for number, topic in enumerate((t for m in system for t in m.outputs), start=1)
        ],
    )


@dataclass
class _Outside:
    """Resource usage of the processes over a time window."""

    begin_ns: int = 0
    end_ns: int = 0
    cpu_ns: int = 0
    pss_bytes: Sequence[int] = ()


@contextmanager
def _measured(pids: Sequence[int], session: Session) -> Iterator[_Outside]:
    receive_threads = session.receive_thread_pids()
    everything = [*pids, *receive_threads]
    outside = _Outside()
    outside.begin_ns = time.time_ns()
    before_ns = cpu_ns(everything)
    yield outside
    outside.cpu_ns = cpu_ns(everything) - before_ns
    outside.end_ns = time.time_ns()
    outside.pss_bytes = [*map(pss_bytes, pids), sum(map(pss_bytes, receive_threads))]


def pss_bytes(pid: int) -> int:
    """Return the PSS of a process: private memory plus its share of shared memory."""
    for line in Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines():
        if line.startswith("Pss:"):
            return int(line.split()[1]) * 1024
    raise ManycoreError(f"/proc/{pid}/smaps_rollup has no line Pss")


def _start(
    session: Session, nodes: Nodes, party: int, member: Member, load: Load, directory: Path
) -> Process:
    command = (
        own_program(MODULE, *_ros_arguments(member, load))
        if nodes == "rclpy"
        else native_command(NATIVE, **native_arguments(member, load))
    )
    with (directory / member.name).open("w") as output, scheduled_as(member.scheduling):
        return session.start(command, party, output=output)


def native_arguments(member: Member, load: Load) -> dict[str, object]:
    """Return the arguments of a native node, but for its parent."""
    return {
        "name": member.name,
        "kind": member.kind,
        "inputs": ",".join(member.inputs),
        "outputs": ",".join(member.outputs),
        "period_ms": member.period_ms,
        "crunch_us": round(load.crunch_ms * US_PER_MS),
        "message": load.message,
        "payload": load.payload,
        "depth": load.depth,
        "report_period_ms": load.report_period_ms,
    }


def _ros_arguments(member: Member, load: Load) -> list[str]:
    parameters: dict[str, object] = {
        "kind": member.kind,
        "outputs": f"[{', '.join(member.outputs)}]",
        "period_ms": member.period_ms,
        "crunch_ms": float(load.crunch_ms),
        "message": load.message,
        "payload": load.payload,
        "depth": load.depth,
        "report_period_ms": load.report_period_ms,
    }
    if member.inputs:
        parameters["inputs"] = f"[{', '.join(member.inputs)}]"
    words = ["--ros-args", "-r", f"__node:={member.name}"]
    for name, value in parameters.items():
        words += ["-p", f"{name}:={value}"]
    return words


def _first_output_ns(directory: Path, processes: Sequence[Process]) -> int:
    """Return when the first message arrived at the end of the graph."""
    deadline = time.monotonic() + TIMEOUT_S
    while time.monotonic() < deadline:
        for process in processes:
            process.raise_if_failed()
        reports = reports_in((directory / LAST).read_text())
        if reports and reports[0].stamp_ns:
            return reports[0].stamp_ns
        time.sleep(POLL_PERIOD_S)
    raise ManycoreError(f"{LAST} has put nothing out within {TIMEOUT_S:g} s")


def _found(directory: Path, start_ns: int, outside: _Outside) -> Found:
    def is_inside(stamp_ns: int) -> bool:
        return outside.begin_ns <= stamp_ns < outside.end_ns

    texts = {path.name: path.read_text() for path in directory.iterdir()}
    reports = [report for text in texts.values() for report in reports_in(text)]
    losses = [loss for text in texts.values() for loss in losses_in(text)]
    window_s = (outside.end_ns - outside.begin_ns) / NS_PER_S
    return Found(
        start_ms=start_ns / 1e6,
        window_s=window_s,
        cpu_ms_per_s=outside.cpu_ns / 1e6 / window_s,
        pss_bytes=outside.pss_bytes,
        reports=[report for report in reports if is_inside(report.stamp_ns)],
        losses=[loss for loss in losses if is_inside(loss.stamp_ns)],
        text=texts[LAST],
    )
