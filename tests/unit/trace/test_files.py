# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Saved traces: round trips, refusal of invalid files, and exact chains."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from rmw_manycore_py.errors import FileError, ManycoreError
from rmw_manycore_py.trace.comparison import compare
from rmw_manycore_py.trace.events import (
    Thread,
    endpoint_id,
)
from rmw_manycore_py.trace.files import load, save
from rmw_manycore_py.trace.flows import flows_of
from rmw_manycore_py.trace.formats import SUFFIXES
from rmw_manycore_py.trace.latency import ChainLatency, Part
from rmw_manycore_py.trace.slices import What, name_of, slices_of
from support.samples.traces import CAMERA, INCARNATION, US, evaluated, example

pytestmark = pytest.mark.unit


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


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"version": 1', '"version": 2, "clock": "tai"', "version: expected 1, found 2"),
        ('"role": "topic"', '"role": "action"', "endpoints.0.role: .* found .*'topic', 'request'"),
        ('"id": ', '"id": 99999', "endpoints.0.id: .* found .*less than"),
        ('"cluster": 3', '"cluster": 1000000', "processes.2.cluster: .* found .*to 64"),
    ],
)
def test_a_header_of_another_version_or_with_other_values_is_refused(
    tmp_path: Path, old: str, new: str, words: str
) -> None:
    path = tmp_path / "t.csv"
    save(example(), path)
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(FileError, match=words):
        load(path)


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


def test_slower_chains_are_reported() -> None:
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
