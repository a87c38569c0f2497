# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bridges, scan matching, counters and messages to several readers in a trace."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.trace.counters import counters_of
from rmw_manycore_py.trace.events import (
    EVENT,
    NO_ENDPOINT,
    Kind,
    Process,
    Thread,
    Trace,
    endpoint_id,
)
from rmw_manycore_py.trace.files import save
from rmw_manycore_py.trace.flows import flows_of
from rmw_manycore_py.trace.slices import What, slices_of
from support.samples.traces import (
    CAMERA,
    INCARNATION,
    SINK,
    US,
    evaluated,
    event,
    example,
    process,
    publish,
)

pytestmark = pytest.mark.unit


def bridged(trace: Trace) -> Trace:
    """The camera's images come from outside, and the sink forwards to the outside."""
    camera, filtering, sink, told = trace.processes
    rows = list(camera.threads[0].events.tolist())
    for at in [i for i, row in enumerate(rows) if row[5] == Kind.PUBLISH_BEGIN][::-1]:
        rows.insert(at, event(rows[at][0] // US - 1, Kind.BRIDGE_IN, CAMERA, 0, 70 * US))
    left = []
    for row in sink.threads[0].events.tolist():
        if row[5] == Kind.RELEASE:
            left.append(event(row[0] // US - 1, Kind.BRIDGE_OUT, SINK))
        left.append(row)
    return Trace("test", (process(1, rows), filtering, process(3, left), told), trace.endpoints, 0)


def test_bridged_hops_are_slices_and_parts_of_chains() -> None:
    trace = bridged(example())
    inwards, outwards = (slices_of(trace.processes[i].threads[0]) for i in (0, 2))
    came = inwards[inwards["what"] == What.BRIDGE_IN]
    assert came["value"].tolist() == [70 * US] * 8
    assert (came["end_ns"] - came["begin_ns"]).tolist() == [6 * US] * 8
    left = outwards[outwards["what"] == What.BRIDGE_OUT]
    assert (left["end_ns"] - left["begin_ns"]).tolist() == [2 * US] * 8
    (found,) = evaluated(trace)
    parts = {part.name: part.quantile(0.5) for part in found.parts}
    assert parts["bridge in /image"] == 70
    assert parts["bridge out /small"] == 2
    assert parts["communication /small"] == 197  # up to the claim: the bridge holds it from then on
    assert parts["total"] == 70 + 33 + 100 + 197 + 2


def matched(trace: Trace) -> Trace:
    """The filter computes in another thread than it takes in, and has two workers."""
    camera, filtering, sink, told = trace.processes
    took, resumed, beside, passes = [], [], [], ([], [])
    for row in filtering.threads[0].events.tolist():
        is_publish = Kind.PUBLISH_BEGIN <= row[5] <= Kind.PUBLISH_END
        (resumed if is_publish else took).append(row)
        if row[5] == Kind.RELEASE:
            t = row[0] // US
            beside.append((row[0] + 2 * US, row[0] + US, 0, 100 + 2, 0, Kind.RESUME))
            end_us = t + 80
            beside.append((end_us * US, (t + 20) * US, end_us * US, NO_ENDPOINT, 0, Kind.ALIGN))
            for worker, (rows, length_us) in enumerate(zip(passes, (10, 6), strict=True)):
                for n in range(2):
                    begin_us = t + 25 + 20 * n + worker
                    rows.append(
                        (
                            end_us * US,
                            begin_us * US,
                            (begin_us + length_us) * US,
                            worker,
                            n,
                            Kind.PASS,
                        )
                    )
    threads = (
        Thread(102, "executor", np.array(took, EVENT), 0),
        Thread(202, "matching", np.array(resumed, EVENT), 0),
    )
    workers = (
        Thread(202, "matching", np.array(beside, EVENT), 0),
        *(Thread(-1 - i, f"NDT worker {i}", np.array(r, EVENT), 0) for i, r in enumerate(passes)),
    )
    both = [
        Process(2, 2, 2, 0, "node", False, True, of_threads, 0) for of_threads in (threads, workers)
    ]
    return Trace("test", (camera, *both, sink, told), trace.endpoints, 0)


def test_scan_matching_is_seen_through_threads_and_workers() -> None:
    trace = matched(example())
    (found,) = evaluated(trace)
    assert found.chain == ("/image", "/small")
    parts = {part.name: part.quantile(0.5) for part in found.parts}
    assert parts["node /filter"] == 100
    assert parts["NDT alignment /filter"] == 60
    assert parts["NDT workers /filter"] == 20  # two passes, the second within the first
    drawn = slices_of(trace.processes[2].threads[1])
    assert set(drawn["what"].tolist()) == {What.PASS}
    assert (drawn["end_ns"] - drawn["begin_ns"]).tolist() == [10 * US] * 16
    assert drawn["number"].tolist() == [0, 1] * 8


def test_counters_follow_queues_losses_cpu_and_smem() -> None:
    publisher = endpoint_id(CAMERA, INCARNATION)
    rows = [
        event(0, Kind.LOST, SINK, 0, 3),  # includes losses before the trace
        *(event(i, Kind.HINT, SINK, i, publisher) for i in (1, 2, 3, 4)),
        event(5, Kind.HINT, SINK, 4, publisher),  # twice the same
        event(6, Kind.LOST, SINK, 0, 2),
        event(7, Kind.CLAIM, SINK, 3, publisher),
        event(8, Kind.EXPIRED, SINK, 4, publisher),
        event(9, Kind.CLAIM, SINK, 9, publisher),  # the message is older than the trace
        event(10, Kind.CPU, NO_ENDPOINT, 0, 1_000 * US),
        event(10, Kind.SMEM, NO_ENDPOINT, 3, 5_000),
        event(20, Kind.CPU, NO_ENDPOINT, 0, 1_005 * US),
        event(20, Kind.SMEM, NO_ENDPOINT, 3, 5_000),
        event(30, Kind.SMEM, NO_ENDPOINT, 3, 7_000),
    ]
    trace = Trace("test", (process(3, rows),), example().endpoints, 0)
    found = {
        counter.name: [
            (time_ns // US, value)
            for time_ns, value in zip(counter.times_ns, counter.values, strict=True)
        ]
        for counter in counters_of(trace)
    }
    lengths = [0, 1, 2, 3, 4, 4, 2, 1, 0, 0]
    assert found == {
        "queue /small /sink": list(enumerate(lengths)),
        "lost /small /sink": [(0, 3), (6, 5)],
        "CPU % cluster 3 > core 2": [(10, 50), (20, 0)],
        "SMEM bytes cluster 3": [(10, 5000), (30, 7000)],
    }


FIRST_OF_MANY = 10


@pytest.mark.needs("perfetto")
def test_a_message_for_many_has_a_flow_to_each(tmp_path: Path) -> None:
    """Takes have no duration; the receive thread reads twice, and is too late for some."""
    from perfetto.protos.perfetto.trace import perfetto_trace_pb2

    takers = range(FIRST_OF_MANY, FIRST_OF_MANY + 30)
    origin = endpoint_id(CAMERA, INCARNATION)
    taken = [
        event(100 + 10 * slot, kind, slot, 1, origin)
        for slot in takers
        for kind in (Kind.CLAIM, Kind.RELEASE)
    ]
    told = [event(at, Kind.RECEIVE, CAMERA, 1, 2) for at in (250, 260)]
    trace = Trace(
        "test",
        (process(1, publish(1, CAMERA, 1)), process(2, told, is_receive_thread=True)),
        example().endpoints,
        0,
    )
    trace = replace(trace, processes=(*trace.processes, process(2, taken)))
    flows = flows_of(trace).flows
    was_told = flows["claim_ns"] >= 250 * US
    assert flows["subscription"].tolist() == [endpoint_id(slot, INCARNATION) for slot in takers]
    assert set(flows["receive_ns"][was_told].tolist()) == {250 * US}
    assert set(flows["receive_thread"][~was_told].tolist()) == {-1}
    save(trace, tmp_path / "t.pftrace")
    parsed = perfetto_trace_pb2.Trace()
    parsed.ParseFromString((tmp_path / "t.pftrace").read_bytes())
    events = [packet.track_event for packet in parsed.packet if packet.HasField("track_event")]
    begins = [list(one.flow_ids) for one in events if one.flow_ids]
    assert begins[0] == list(range(1, 31))
    assert sorted(i for one in events for i in one.terminating_flow_ids) == begins[0]
    depth: Counter[int] = Counter()
    for one in events:
        depth[one.track_uuid] += {1: 1, 2: -1}.get(one.type, 0)
        assert depth[one.track_uuid] >= 0


@pytest.mark.needs("matplotlib")
def test_a_message_is_drawn_with_its_threads(tmp_path: Path) -> None:
    save(example(), tmp_path / "t.json")
    drawn = CliRunner().invoke(
        cli, ["trace", "draw", str(tmp_path / "t.json"), "-o", str(tmp_path / "t.svg")]
    )
    assert drawn.exit_code == 0, drawn.output
    picture = (tmp_path / "t.svg").read_text()
    for label in ("core 2 &gt; /camera", "core 2 &gt; /filter", "receive thread"):
        assert label in picture.replace("> ", "&gt; "), label
    none = [
        "trace",
        "draw",
        str(tmp_path / "t.json"),
        "-o",
        str(tmp_path / "n.svg"),
        "--chain",
        "/a",
    ]
    refused = CliRunner().invoke(cli, none)
    assert refused.exit_code != 0
    assert "no message went through /a; the chains of the trace: /image /small" in str(
        refused.output or refused.exception
    )
    assert not (tmp_path / "n.svg").exists()
