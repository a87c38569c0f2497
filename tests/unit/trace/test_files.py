# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Saved traces: what is written is read again, what is no trace is refused, chains are exact."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.errors import FileError, ManycoreError
from rmw_manycore_py.trace.chains import Messages
from rmw_manycore_py.trace.comparison import compare
from rmw_manycore_py.trace.counters import counters_of
from rmw_manycore_py.trace.events import (
    EVENT,
    NO_ENDPOINT,
    Endpoint,
    Kind,
    Process,
    Thread,
    Trace,
    endpoint_id,
)
from rmw_manycore_py.trace.files import SUFFIXES, load, save
from rmw_manycore_py.trace.flows import flows_of
from rmw_manycore_py.trace.latency import ChainLatency, Part, latencies
from rmw_manycore_py.trace.slices import What, name_of, slices_of

pytestmark = pytest.mark.unit

US = 1000
CAMERA, FILTER_IN, FILTER_OUT, SINK = 1, 2, 3, 4
NAMES = {
    CAMERA: (True, "/image", "/camera"),
    FILTER_IN: (False, "/image", "/filter"),
    FILTER_OUT: (True, "/small", "/filter"),
    SINK: (False, "/small", "/sink"),
}
INCARNATION = 1 << 16 | 5  # events have its low bits


def event(time_us: int, kind: Kind, slot: int, number: int = 0, value: int = 0):
    return (time_us * US, number, value, slot, 0 if slot == NO_ENDPOINT else 5, kind)


def publish(at_us: int, slot: int, number: int) -> list:
    return [
        event(at_us, Kind.PUBLISH_BEGIN, slot, 0, 64),
        event(at_us + 1, Kind.SERIALIZE_BEGIN, slot, number),
        event(at_us + 2, Kind.WRITE, slot, number, 60),
        event(at_us + 5, Kind.PUBLISH_END, slot, number),
    ]


def take(at_us: int, slot: int, number: int, publisher: int) -> list:
    origin = endpoint_id(publisher, INCARNATION) | 1 << 48  # all of the incarnation
    return [
        event(at_us, Kind.CLAIM, slot, number, origin),
        event(at_us + 3, Kind.RELEASE, slot, number, origin),
    ]


def wait(begin_us: int, end_us: int) -> list:
    none = NO_ENDPOINT
    return [event(begin_us, Kind.WAIT_BEGIN, none), event(end_us, Kind.WAIT_END, none, 0, 1)]


def process(cluster: int, rows: list, *, lost: int = 0, is_receive_thread: bool = False) -> Process:
    thread = Thread(100 + cluster, "python", np.array(rows, EVENT), lost)
    return Process(
        cluster, cluster, None if is_receive_thread else 2, 0, "node", is_receive_thread, True,
        (thread,), 0,
    )  # fmt: skip


def example(slower_us: int = 0, rounds: int = 8, *, twice: bool = False) -> Trace:
    """Camera, filter and sink in three clusters; the sink's clusters are told by a thread."""
    camera, filtering, sink, told = [], [], [], []
    for i in range(1, rounds + 1):
        t = 10_000 * i
        camera += publish(t, CAMERA, i)
        told.append(event(t + 10, Kind.RECEIVE, CAMERA, i, 2))
        told.append(event(t + 11, Kind.HINT, FILTER_IN, i, endpoint_id(CAMERA, INCARNATION)))
        filtering += wait(t - 100, t + 20) + take(t + 30, FILTER_IN, i, CAMERA)
        filtering += publish(t + 133 + slower_us, FILTER_OUT, 2 * i)
        sink += wait(t - 100, t + 300) + take(t + 330 + slower_us, SINK, 2 * i, FILTER_OUT)
        if twice:
            filtering += publish(t + 150, FILTER_OUT, 2 * i + 1)
            sink += wait(t + 335, t + 340) + take(t + 350, SINK, 2 * i + 1, FILTER_OUT)
    endpoints = {
        endpoint_id(slot, INCARNATION): Endpoint(
            is_publisher, "topic", topic, "std_msgs/msg/String", node, 1
        )
        for slot, (is_publisher, topic, node) in NAMES.items()
    }
    return Trace(
        "test",
        (
            process(1, camera, lost=3),
            process(2, filtering),
            process(3, sink),
            process(2, told, is_receive_thread=True),
        ),
        endpoints,
        4,
    )


def evaluated(trace: Trace) -> list[ChainLatency]:
    messages = Messages(trace)
    return latencies(messages, messages.chains)


@pytest.mark.needs("perfetto")
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_what_is_saved_is_read_again(tmp_path: Path, suffix: str) -> None:
    trace = example()
    save(trace, tmp_path / f"t{suffix}")
    again = load(tmp_path / f"t{suffix}")
    assert (again.platform, again.endpoints, again.lost) == ("test", trace.endpoints, 7)
    assert again.event_count == trace.event_count
    for (old, before), (new, after) in zip(trace.threads(), again.threads(), strict=True):
        assert (old.cluster, old.core, old.label) == (new.cluster, new.core, new.label)
        assert before.events.tolist() == after.events.tolist()
    assert [p.name for p in tmp_path.iterdir()] == [f"t{suffix}"]


@pytest.mark.needs("perfetto")
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_what_is_no_whole_trace_is_refused_by_name(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"t{suffix}"
    save(example(), path)
    whole = path.read_bytes()
    foreign = b'{"traceEvents": []}', b"time,name\n1,x\n", b"\x0a\x02\x08\x01", b"[1]", b"\xff" * 99
    for content in (b"", *foreign, whole[: len(whole) // 3], whole[:1500], whole[:-9], whole[:-2]):
        path.write_bytes(content)
        if suffix == ".csv" and content == whole[:-9]:
            path.write_bytes(whole[: whole.rindex(b"\n", 0, -1) + 1])  # a whole line is missing
        with pytest.raises(FileError) as refused:
            load(path)
        assert str(path) in str(refused.value)
    with pytest.raises(ManycoreError, match="cannot be read"):
        load(tmp_path / f"none{suffix}")


def test_each_take_has_one_flow_through_the_receive_thread() -> None:
    trace = example()
    flows = flows_of(trace)
    assert len(flows.flows) == 16
    assert flows.without_publish == 0
    assert Counter((flows.flows["receive_thread"] >= 0).tolist()) == {True: 8, False: 8}
    assert (flows.flows["write_ns"] < flows.flows["claim_ns"]).all()


@pytest.mark.needs("perfetto")
def test_perfetto_gets_one_flow_for_each_take_and_tracks_in_their_places(tmp_path: Path) -> None:
    from perfetto.protos.perfetto.trace import perfetto_trace_pb2

    save(example(), tmp_path / "t.pftrace")
    parsed = perfetto_trace_pb2.Trace()
    parsed.ParseFromString((tmp_path / "t.pftrace").read_bytes())
    begins: Counter[int] = Counter()
    ends: Counter[int] = Counter()
    depth: Counter[int] = Counter()
    times: dict[int, int] = {}
    arguments: set[tuple[str, int]] = set()
    for packet in parsed.packet:
        event = packet.track_event
        begins.update(event.flow_ids)
        ends.update(event.terminating_flow_ids)
        track = event.track_uuid
        if packet.HasField("track_event"):
            assert packet.timestamp >= times.get(track, 0)
            times[track] = packet.timestamp
            depth[track] += {1: 1, 2: -1}.get(event.type, 0)
            assert depth[track] >= 0
        arguments.update((a.name, a.uint_value) for a in event.debug_annotations)
    assert set(depth.values()) == {0}
    assert ends == dict.fromkeys(range(1, 17), 1)
    assert set(begins) == set(ends)
    assert arguments == {
        ("bytes", 64),
        ("end", 0),
        *(("number", i) for i in range(1, 17) if i < 9 or i % 2 == 0),
    }
    assert max(times.values()) == 80_333 * US  # the last event of the last round
    tracks = {p.track_descriptor.uuid: p.track_descriptor for p in parsed.packet}
    thread = next(t for t in tracks.values() if t.name == "python (103)")
    path = []
    while thread.parent_uuid:
        thread = tracks[thread.parent_uuid]
        path.append(thread.name)
    assert path == ["/sink", "core 2", "cluster 3"]


def test_slices_of_a_node() -> None:
    trace = example(rounds=2)
    slices = slices_of(trace.processes[1].threads[0])
    assert (np.diff(slices["begin_ns"]) >= 0).all()
    spans = {
        (name_of(trace, one["what"], one["endpoint"]), one["begin_ns"] // US, one["end_ns"] // US)
        for one in slices[slices["begin_ns"] < 15_000 * US]
    }
    assert spans == {
        ("wait", 9_900, 10_020),
        ("take /image", 10_030, 10_033),
        ("callback /image", 10_033, 19_900),
        ("serialize", 10_134, 10_135),
        ("publish /small", 10_133, 10_138),
    }


def test_hops_add_up_and_are_what_caret_calls_them() -> None:
    (found,) = evaluated(example())
    assert found.chain == ("/image", "/small")
    assert found.nodes == ("/filter", "/sink")
    assert {part.name: part.quantile(0.5) for part in found.parts} == {
        "communication /image": 33,
        "node /filter": 100,
        "communication /small": 200,
        "total": 333,
        "reaction": 10_333,
        "data age": 10_333,
    }


def test_what_got_slower_is_told() -> None:
    changes = compare(evaluated(example()), evaluated(example(slower_us=50)))
    assert {change.part: change.verdict for change in changes} == {
        "communication /image": "same",
        "node /filter": "slower",
        "communication /small": "same",
        "total": "slower",
        "reaction": "slower",
        "data age": "slower",
    }
    few = compare(evaluated(example(rounds=3)), evaluated(example(rounds=3)))
    assert {change.verdict for change in few} == {"too few"}


def test_medians_whose_intervals_overlap_are_the_same() -> None:
    def of(first: int) -> list[ChainLatency]:
        parts = (Part("total", tuple(range(first, first + 20))),)
        return [ChainLatency(("/a",), ("/b",), parts)]

    verdicts = {n: compare(of(0), of(n))[0].verdict for n in (-30, -2, 0, 2, 30)}
    assert verdicts == {-30: "faster", -2: "same", 0: "same", 2: "same", 30: "slower"}


def test_a_second_answer_to_one_input_is_no_new_reaction() -> None:
    (found,) = evaluated(example(twice=True))
    parts = {part.name: part for part in found.parts}
    assert (parts["reaction"].quantile(0), parts["reaction"].quantile(1)) == (10_333, 10_333)
    assert len(parts["reaction"].samples_us) == 7
    assert (parts["data age"].quantile(0), parts["data age"].quantile(1)) == (353, 10_333)


def test_a_publish_that_a_kill_cut_short_is_drawn_for_its_takes() -> None:
    trace = example(rounds=1)
    camera = trace.processes[0].threads[0]
    cut = Thread(camera.tid, camera.name, camera.events[:3], 0)
    (one,) = (s for s in slices_of(cut) if s["what"] == What.PUBLISH)
    assert (one["publisher"], one["number"]) == (endpoint_id(CAMERA, INCARNATION), 1)
    assert not one["is_end_known"]


def bridged(trace: Trace) -> Trace:
    """The camera's images come from outside, and the sink passes on to the outside."""
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
    assert parts["communication /small"] == 197  # to the claim: the bridge has it from then on
    assert parts["total"] == 70 + 33 + 100 + 197 + 2


def matched(trace: Trace) -> Trace:
    """The filter works in another thread than it takes in, and has two workers."""
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
    assert parts["NDT workers /filter"] == 20  # two passes, the second worker's within the first's
    drawn = slices_of(trace.processes[2].threads[1])
    assert set(drawn["what"].tolist()) == {What.PASS}
    assert (drawn["end_ns"] - drawn["begin_ns"]).tolist() == [10 * US] * 16
    assert drawn["number"].tolist() == [0, 1] * 8


def test_counters_follow_queues_losses_cpu_and_smem() -> None:
    publisher = endpoint_id(CAMERA, INCARNATION)
    rows = [
        event(0, Kind.LOST, SINK, 0, 3),  # they came before the trace, too
        *(event(i, Kind.HINT, SINK, i, publisher) for i in (1, 2, 3, 4)),
        event(5, Kind.HINT, SINK, 4, publisher),  # twice the same
        event(6, Kind.LOST, SINK, 0, 2),
        event(7, Kind.CLAIM, SINK, 3, publisher),
        event(8, Kind.EXPIRED, SINK, 4, publisher),
        event(9, Kind.CLAIM, SINK, 9, publisher),  # it was there before the trace
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
    """Takes take no time; the receive thread looks twice, and is too late for some."""
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
