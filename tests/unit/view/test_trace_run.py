# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Looks at a trace: what had happened by a moment, as a viewer of the platform would have seen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.platform.monitor.graph import Endpoint
from rmw_manycore_py.prediction import predict
from rmw_manycore_py.prediction.target_file import TARGETS
from rmw_manycore_py.trace.events import EVENT, Kind, Thread, Trace
from rmw_manycore_py.view.page_state import PageState
from rmw_manycore_py.view.trace_run import LAST_STEP, TraceRun
from rmw_manycore_py.view.trace_viewer import TraceViewer
from support.samples.profiles import pipeline, sites
from support.samples.traces import SINK, event, example

pytestmark = pytest.mark.unit


@pytest.fixture(scope="module")
def simulated() -> TraceRun:
    """Return camera, filter and sink at 10 Hz, simulated in three clusters for 10 s."""
    found = predict(sites(1, 2, 3), pipeline(), TARGETS["host"], duration_s=10, is_traced=True)
    assert found.trace is not None
    return TraceRun(found.trace, "simulated.json")


def test_the_whole_run_has_the_rates_and_loads_of_the_application(simulated: TraceRun) -> None:
    loads = simulated.whole.loads
    assert simulated.duration_s == pytest.approx(10, abs=0.2)
    assert loads.seconds == simulated.duration_s
    for topic in ("/image", "/small"):
        assert loads.topics[topic].rate_hz == pytest.approx(10, abs=0.2)
        assert loads.topics[topic].message_bytes == 1000
    pids = {member.nodes: member.pid for member in loads.graph.members}
    assert loads.cpu_share(pids["/filter",]) == pytest.approx(0.3, abs=0.02)
    assert loads.receive_thread_rates_hz()[2] == pytest.approx(10, abs=0.2)
    assert simulated.whole.latencies["/image"].count == pytest.approx(100, abs=1)


def test_a_moment_has_the_rates_of_the_time_before_it(simulated: TraceRun) -> None:
    assert not simulated.look_at(0).loads.rates_hz.any()
    middle = simulated.look_at(LAST_STEP // 2).loads
    assert middle.seconds == pytest.approx(2, abs=0.05)
    assert middle.topics["/image"].rate_hz == pytest.approx(10, abs=0.6)
    messages = [
        int(simulated.look_at(step).loads.after.counts[:, 0].sum()) for step in range(0, 600, 50)
    ]
    assert messages == sorted(messages)
    assert len(set(messages)) == len(messages)


def test_the_history_has_what_each_moment_shows(simulated: TraceRun) -> None:
    """The history is counted in one pass, a moment from the begin."""
    rates = simulated.history.whole()["series"]["messages/s"]
    for step in (1, 2, 150, 151, LAST_STEP):
        now = float(simulated.look_at(step).loads.rates_hz.sum())
        assert now > 0 or step < 3
        assert rates[step] == pytest.approx(now)


def test_endpoints_are_those_of_their_processes(simulated: TraceRun) -> None:
    graph = simulated.whole.graph
    nodes = {member.slot: member.nodes for member in graph.members}
    places = {member.nodes: (member.cluster, member.core) for member in graph.members}
    assert places == {("/camera",): (1, 1), ("/filter",): (2, 2), ("/sink",): (3, 3)}
    assert {(one.kind, one.topic): nodes[one.process] for one in graph.endpoints} == {
        ("publisher", "/image"): ("/camera",),
        ("subscription", "/image"): ("/filter",),
        ("publisher", "/small"): ("/filter",),
        ("subscription", "/small"): ("/sink",),
    }
    assert {topic for arc in simulated.chip.layout.arcs for topic in arc.wire.topics} == {
        "/image",
        "/small",
    }


def split(trace: Trace, at: int) -> Trace:
    """Return a trace whose first process was replaced by another after half of its events."""
    first, *others = trace.processes
    (thread,) = first.threads
    parts = [
        replace(first, pid=pid, threads=(Thread(pid, "python", events, 0),))
        for pid, events in ((71, thread.events[:at]), (72, thread.events[at:]))
    ]
    return replace(trace, processes=(*reversed(parts), *others))


def test_a_restarted_node_is_one_node() -> None:
    trace = example(rounds=8)
    once, twice = TraceRun(trace, "a"), TraceRun(split(trace, at=12), "b")
    assert [member.pid for member in twice.whole.graph.members if "/camera" in member.nodes] == [72]
    endpoints: list[tuple[Endpoint, ...]] = [one.whole.graph.endpoints for one in (once, twice)]
    assert [one.topic for one in endpoints[0]] == [one.topic for one in endpoints[1]]
    assert np.array_equal(once.whole.loads.after.counts, twice.whole.loads.after.counts)


def test_a_restarted_receive_thread_goes_on_counting() -> None:
    trace = example(rounds=8)
    *others, told = trace.processes
    (thread,) = told.threads
    parts = [
        replace(told, pid=pid, threads=(Thread(pid, "receive", events, 0),))
        for pid, events in ((81, thread.events[:8]), (82, thread.events[8:]))
    ]
    runs = TraceRun(trace, "a"), TraceRun(replace(trace, processes=(*others, *parts)), "b")
    counts = [{one.id: one.messages for one in run.whole.loads.after.clusters} for run in runs]
    assert counts[0] == counts[1] == {1: 0, 2: 8, 3: 0}


def test_losses_are_events_with_their_times() -> None:
    trace = example(rounds=8)
    *others, sink, told = trace.processes
    (thread,) = sink.threads
    lost = np.array([event(50_000, Kind.LOST, SINK, 0, 3)], EVENT)
    events = np.sort(np.concatenate([thread.events, lost]), order="time_ns")
    sink = replace(sink, threads=(replace(thread, events=events),))
    run = TraceRun(replace(trace, processes=(*others, sink, told)), "lossy")
    (happened,) = run.events
    assert happened.text == "/small: 3 lost by /sink"
    begin_s = min(int(t.events["time_ns"][0]) for _, t in trace.threads()) / 1e9
    assert happened.time_s == pytest.approx(0.05 - begin_s, abs=2 * run.duration_s / LAST_STEP)
    assert run.whole.loads.topics["/small"].lost == 3


def test_a_page_moves_through_the_trace(simulated: TraceRun) -> None:
    state = PageState(TraceViewer(simulated))
    first = state.news()
    assert first["position"]["step"] is None
    assert len(first["charts"]["times"]) == LAST_STEP + 1
    assert first["totals"]["messages/s"] == pytest.approx(20, abs=0.5)
    state.receive({"seek": 0})
    news = state.news()
    assert (news["position"]["step"], news["totals"]["messages/s"]) == (0, 0)
    assert "charts" not in news
    assert news["marks"]
    state.receive({"seek": 10**9, "select": {"node": "/filter"}})
    news = state.news()
    assert news["position"]["step"] == LAST_STEP
    assert len(news["details"]["charts"]["times"]) == LAST_STEP + 1
    state.receive({"seek": None})
    news = state.news()
    assert news["position"]["step"] is None
    assert news["details"]["charts"]["times"] == []


def test_a_trace_without_events_is_refused() -> None:
    with pytest.raises(ManycoreError, match=r"empty\.json: the trace has no events"):
        TraceRun(Trace("p", (), {}, 0), "empty.json")
