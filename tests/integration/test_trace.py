# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Traces of real nodes: each take has one flow from its publish, also after kills."""

from __future__ import annotations

import json
import re
import resource
import signal
import time
from collections import defaultdict
from pathlib import Path

import pytest

from rmw_manycore_py.errors import EXIT_BAD_INPUT
from rmw_manycore_py.trace.events import Kind
from rmw_manycore_py.trace.files import load
from rmw_manycore_py.trace.flows import NO_THREAD, flows_of
from rmw_manycore_py.view.tracing import Tracing
from support import IS_MANYCORE, MAPFILES, wait_until
from support.nodes.speakers import hear as hear_topic
from support.nodes.speakers import say
from support.peers.programs import forked_manycore
from support.processes.commands import manycore_command
from support.processes.inspection import kill, receive_threads_of
from support.processes.platforms import PLATFORMS, entries

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

SECOND = ("topic", "pub", "-r", "20", "/chatter", "std_msgs/msg/String")


def hear(talking) -> None:
    """Wait until a message was received that was published after the call."""
    talker, listener = talking
    now_s = time.time()
    said = r"\[([\d.]+)\] \[talker\]: Publishing: 'Hello World: (\d+)'"
    while float((found := talker.wait_for(said)).group(1)) < now_s:
        pass
    number = int(found.group(2)) + 1  # only published after that line was written
    while int(listener.wait_for(r"I heard: 'Hello World: (\d+)'").group(1)) < number:
        pass


def hear_again(hearer) -> None:
    """Wait until a text was received that was said after the call."""
    now_ns = time.time_ns()
    while int(hearer.wait_for(r"^heard again (\d+) ").group(1)) < now_ns:
        pass


def check_flows(trace) -> int:
    """Check that each take with a known publish has one flow, forward in time; return how many."""
    claims = sum(int((t.events["kind"] == Kind.CLAIM).sum()) for _, t in trace.threads())
    flows = flows_of(trace)
    assert len(flows.flows) + flows.without_publish == claims
    takes = set(flows.flows[["subscription", "publisher", "number"]].tolist())
    assert len(takes) == len(flows.flows)
    for flow in flows.flows:
        times = [flow["write_ns"], flow["claim_ns"]]
        times[1:1] = [flow["receive_ns"]] if flow["receive_thread"] != NO_THREAD else []
        assert times == sorted(times)
    return len(flows.flows)


def check_drawn(path) -> None:
    """Check that the flow events that viewers draw lead from a publish to a take."""
    events = json.loads(path.read_bytes())["traceEvents"]
    slices = defaultdict(list)
    for event in events:
        if event["ph"] == "X":
            slices[event["pid"], event["tid"]].append(event)
    phases = defaultdict(list)
    for event in events:
        if event["ph"] in "stf":
            phases[event["id"]].append(event)
    assert phases
    for steps in phases.values():
        assert [step["ph"] for step in steps] in (["s", "f"], ["s", "t", "f"])
        kinds = {"s": "publish", "t": "receive", "f": "take"}
        for step in steps:
            around = [
                one
                for one in slices[step["pid"], step["tid"]]
                if one["ts"] <= step["ts"] <= one["ts"] + one["dur"] + 0.001
            ]
            assert any(one["cat"] == kinds[step["ph"]] for one in around), step


def test_a_run_is_traced_from_beginning_to_end(start, tmp_path) -> None:
    path = tmp_path / "trace.json"
    run = start(forked_manycore("run", MAPFILES / "talker_listener.yaml", "--trace", path))
    for _ in range(3):
        run.wait_for("I heard")
    assert run.stop() == 0, run
    trace = load(path)
    assert trace.lost == 0
    assert flows_of(trace).without_publish == 0
    assert check_flows(trace) >= 3
    check_drawn(path)
    flows = flows_of(trace).flows
    chatter = [flow for flow in flows if trace.topic_of(int(flow["publisher"])) == "/chatter"]
    # A subscription that resyncs, as with its first hint, finds later messages itself.
    assert any(flow["receive_thread"] != NO_THREAD for flow in chatter)


def test_a_run_is_not_started_if_its_trace_cannot_be_written(start, platform) -> None:
    mapfile = MAPFILES / "talker_listener.yaml"
    for words in (
        ("run", mapfile, "--trace", "/sys/trace.json"),
        ("profile", "record", mapfile, "-o", "/sys/profile.json"),
    ):
        refused = start(forked_manycore(*words))
        assert refused.wait() == EXIT_BAD_INPUT, refused
        assert re.search(r"/sys/\w+\.json: cannot be written: ", refused.output), refused
        assert "talker" not in refused.output, refused


def test_a_trace_whose_directory_has_gone_is_saved_elsewhere(start, tmp_path) -> None:
    directory = tmp_path / "gone"
    directory.mkdir()
    words = ("run", MAPFILES / "talker_listener.yaml", "--trace", directory / "trace.json")
    run = start(manycore_command(*words), TMPDIR=str(tmp_path))
    run.wait_for("I heard")
    directory.rmdir()
    assert run.stop() == 1, run
    found = run.wait_for(rf"{directory}/trace\.json: cannot be written: .*; the trace is in (.*)$")
    assert check_flows(load(Path(found.group(1)))) >= 1


def test_a_trace_is_started_stopped_saved_and_evaluated(talking, manycore, start, tmp_path) -> None:
    manycore("trace", "start")
    hear(talking)
    manycore("trace", "stop")
    assert "not traced" in manycore("trace", "status")
    manycore("trace", "save", "-o", tmp_path / "a.json")

    def is_all_saved() -> bool:
        """Save the events that threads were writing when the trace was stopped, if any."""
        save = start(forked_manycore("trace", "save", "-o", str(tmp_path / "b.json")))
        return save.wait() == 1 and "recorded nothing" in save.output

    wait_until(is_all_saved, "no event is left")
    trace = load(tmp_path / "a.json")
    assert check_flows(trace) >= 1
    shown = manycore("trace", "latency", tmp_path / "a.json", "--json")
    parts = json.loads(shown)[0]["parts"]
    assert parts[0]["part"] == "communication /chatter"
    assert parts[0]["count"] >= 1


def test_killed_nodes_and_receive_threads_leave_their_events(
    talking, manycore, start, platform, tmp_path
) -> None:
    talker, listener = talking
    manycore("trace", "start")
    hear(talking)
    for pid in receive_threads_of(platform):
        kill(pid)
    hear(talking)
    talker.signal(signal.SIGKILL)
    talker.wait()
    second = start(forked_manycore(*SECOND, "data: second"))
    for _ in range(2):
        listener.wait_for("I heard: 'second'")
    status = json.loads(manycore("trace", "status", "--json"))
    assert status["on"]
    assert status["events"] > 0
    assert status["lost"] == 0
    files = set(entries(PLATFORMS / platform, "trace-*"))
    manycore("trace", "save", "-o", tmp_path / "trace.json")
    trace = load(tmp_path / "trace.json")
    assert check_flows(trace) >= 4
    check_drawn(tmp_path / "trace.json")
    gone = [process for process in trace.processes if not process.is_alive]
    assert {process.is_receive_thread for process in gone} == {True, False}
    # Meanwhile a thread may have begun another file.
    assert len(files - set(entries(PLATFORMS / platform, "trace-*"))) == len(gone)
    second.stop()


def test_bridged_hops_are_parts_of_chains(bridge, manycore, tmp_path) -> None:
    bridge.run(bridge.route("inward", "/news"), bridge.route("outward", "/a"))
    bridge.outside(say, "/news", {}, 0.05)
    bridge.inside(say, "/a", {}, 0.05)
    hearers = (bridge.inside(hear_topic, "/news", {}), bridge.outside(hear_topic, "/a", {}))
    for hearer in hearers:
        hearer.wait_for("^heard again")
    manycore("trace", "start")
    for hearer in hearers:
        hear_again(hearer)
    live = json.loads(manycore("trace", "latency", "--live", "--json"))
    manycore("trace", "stop")
    manycore("trace", "save", "-o", tmp_path / "trace.json")
    saved = json.loads(manycore("trace", "latency", tmp_path / "trace.json", "--json"))
    for chains in (live, saved):  # showing it removed nothing
        parts = {one["chain"][0]: one["parts"] for one in chains}
        assert [part["part"] for part in parts["/news"][:2]] == [
            "bridge in /news",
            "communication /news",
        ]
        assert [part["part"] for part in parts["/a"][:2]] == ["communication /a", "bridge out /a"]
        assert all(part["count"] >= 1 for topic in parts for part in parts[topic][:2])


def test_lost_events_are_reported(talking, manycore, tmp_path) -> None:
    manycore("trace", "start", "--events", "128")
    wait_until(lambda: json.loads(manycore("trace", "status", "--json"))["lost"], "a ring is full")
    output = manycore("trace", "save", "-o", tmp_path / "trace.csv")
    assert "were lost" in output
    trace = load(tmp_path / "trace.csv")
    assert trace.lost > 0
    check_flows(trace)


def test_a_trace_of_losses_alone_is_saved(talking, manycore, platform, tmp_path) -> None:
    """A process without free file descriptors has no ring."""
    talker = talking[0]

    def lose_all() -> None:
        manycore("trace", "start", "--node", "/talker")
        wait_until(
            lambda: json.loads(manycore("trace", "status", "--json"))["lost"], "events are lost"
        )

    resource.prlimit(talker.pid, resource.RLIMIT_NOFILE, (0, 0))
    lose_all()
    manycore("trace", "stop")
    assert "lost" in manycore("trace", "save", "-o", tmp_path / "lost.json")
    lose_all()
    assert Tracing(platform, tmp_path).stop()["lost"] > 0
    for path in (tmp_path / "lost.json", tmp_path / f"{platform}-1.json"):
        trace = load(path)
        assert (trace.event_count, trace.lost > 0) == (0, True)


def test_one_trace_at_a_time_and_none_is_thrown_away(talking, manycore, tmp_path) -> None:
    assert "not being traced" in manycore("trace", "stop", status=1)
    assert "no node '/nobody'" in manycore("trace", "start", "--node", "/nobody", status=1)
    manycore("trace", "start", "--node", "/talker")
    assert "only one trace can run at a time" in manycore("trace", "start", status=1)
    wait_until(
        lambda: json.loads(manycore("trace", "status", "--json"))["events"], "the talker publishes"
    )
    assert "only one trace can run at a time" in manycore("trace", "start", "--discard", status=1)
    assert json.loads(manycore("trace", "status", "--json"))["events"]
    manycore("trace", "stop")
    assert "was not saved" in manycore("trace", "start", status=1)
    manycore("trace", "start", "--discard", "--cluster", "2")
    manycore("trace", "stop")


def test_a_full_disk_costs_no_trace(talking, manycore, start, tmp_path) -> None:
    manycore("trace", "start")
    hear(talking)
    manycore("trace", "stop")
    path = tmp_path / "trace.json"
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
    try:
        # Else Python would cut the files of compiled modules that it writes.
        words = manycore_command("trace", "save", "-o", path)
        save = start(words, PYTHONDONTWRITEBYTECODE="1")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert save.wait() == 1, save
    assert "the trace is kept" in save.output
    assert list(tmp_path.iterdir()) == []
    manycore("trace", "save", "-o", path)
    assert check_flows(load(path)) >= 1
