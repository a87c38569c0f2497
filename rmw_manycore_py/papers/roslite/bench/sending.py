# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fig. 13: what each node sends, by each transfer; from a trace of the pipeline."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Mapping

from rmw_manycore_py.bench.question import Run
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.enums import Transfer
from rmw_manycore_py.native.errors import translate_native_errors
from rmw_manycore_py.papers.roslite.bench.drives import drive
from rmw_manycore_py.papers.roslite.variants import AFTER, installed, with_transfer
from rmw_manycore_py.trace.chains import Messages
from rmw_manycore_py.trace.events import Kind, RecordId, Trace, endpoint_in
from rmw_manycore_py.trace.recorded import looked_at

TRANSFERS: tuple[Transfer, ...] = ("dsm", "message", "session", "async")
# What lane_rule sends is latched, and a transferred topic has no history.
SENT = {
    "lane_select": "/base_waypoints",
    "waypoint_filter": "/safety_waypoints",
    "velocity_set": "/final_waypoints",
    "pure_pursuit": "/twist_raw",
    "twist_filter": "/twist_cmd",
}
LANES = (1000, 4000)  # waypoints
WINDOW_S = 20.0  # of all rounds together
SCANS = 10  # before it, so that all nodes have something to send
NS_PER_US = 1000


def question_of(node: str, waypoints: int) -> str:
    """Return the name of the question about what a node sends."""
    return f"sending of {node}, {waypoints} waypoints"


def measure(run: Run) -> list[Result]:
    """Measure each lane with each transfer in turns."""
    samples: dict[tuple[str, str], list[float]] = defaultdict(list)
    for turn in range(run.rounds):
        for waypoints in LANES:
            for transfer in TRANSFERS:
                name = f"sending, {waypoints} waypoints: {transfer}"
                if not run.wants(name):
                    continue
                run.note(f"{name}, round {turn + 1} of {run.rounds}")
                try:
                    found = _sent(transfer, waypoints, run.share * WINDOW_S / run.rounds)
                except ManycoreError as error:
                    run.failures.append(f"{name}: {error}")
                    continue
                for node, topic in SENT.items():
                    samples[question_of(node, waypoints), transfer] += found.get(topic, [])
    return [
        Result(question, transfer, "us", tuple(times))
        for (question, transfer), times in sorted(samples.items())
        if times
    ]


def _sent(transfer: Transfer, waypoints: int, window_s: float) -> Mapping[str, list[float]]:
    """Return by topic how long messages take to another cluster, in us."""

    def traced(platform: str) -> Trace:
        with translate_native_errors("trace"):
            _transport.start_trace(platform, clusters=(), nodes=(), events=0, discard=True)
        time.sleep(window_s)
        return looked_at(platform)

    variant = with_transfer(installed(AFTER), list(SENT.values()), transfer, waypoints)
    _, trace = drive(variant, SCANS, waypoints=waypoints, meanwhile=traced)
    return sending_us(trace)


def sending_us(trace: Trace) -> dict[str, list[float]]:
    """Return by topic the time in us from publish to the first hint, and of the take.

    What lies between does not count: the receiving node may be busy with something else.
    """
    published_ns = Messages(trace).published_ns
    hinted_ns: dict[RecordId, int] = {}
    takes: list[tuple[RecordId, int]] = []
    for _, thread in trace.threads():
        claimed_ns = 0
        for time_ns, number, value, _, _, kind in thread.events.tolist():
            record = (endpoint_in(value), number)
            if kind == Kind.HINT:
                hinted_ns[record] = min(time_ns, hinted_ns.get(record, time_ns))
            elif kind == Kind.CLAIM:
                claimed_ns = time_ns
            elif kind == Kind.RELEASE:
                takes.append((record, time_ns - claimed_ns))
    found: dict[str, list[float]] = defaultdict(list)
    for record, take_ns in takes:
        if record in published_ns and record in hinted_ns:
            sent_ns = hinted_ns[record] - published_ns[record]
            found[trace.topic_of(record[0])].append((sent_ns + take_ns) / NS_PER_US)
    return found
