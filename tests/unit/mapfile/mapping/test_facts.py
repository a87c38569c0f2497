# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a mapping says: topics that cross clusters, loads at the rates of a trace, a verdict."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.mapfile import check
from rmw_manycore_py.mapfile.mapping import Facts, facts_of
from rmw_manycore_py.mapfile.mapping.crossing import Publication, Traffic
from rmw_manycore_py.mapfile.mapping.recorded import Recorded
from rmw_manycore_py.mapfile.mapping.verdict import verdict
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
from rmw_manycore_py.trace.files import save
from support.samples.traces import INCARNATION, US, event, example, publish, starting, wait

pytestmark = pytest.mark.unit

TEXT = "std_msgs/msg/String"
NODE = "from rclpy.node import Node\nclass Quiet(Node):\n    pass\n"
COMPUTED = (
    "from rclpy.node import Node\nfrom std_msgs.msg import String\nclass Loud(Node):\n"
    "    def start(self, name):\n        self.create_publisher(String, name, 10)\n"
)
LOG = 9  # slot
ROUNDS, MESSAGE_BYTES = 8, 60  # of example()
Placed = Callable[..., Path]


@pytest.fixture
def placed(tmp_path: Path) -> Placed:
    """Return a function that writes a mapfile of camera, filter and sink in these clusters."""
    (tmp_path / "quiet.py").write_text(NODE)
    (tmp_path / "computed.py").write_text(COMPUTED)

    def write(camera: int, filtering: int, sink: int, more: str = "") -> Path:
        text = (
            "platform: coolidge\nnodes:\n"
            f"  camera: {{cluster: {camera}, script: quiet.py, publish: {{image: {TEXT}}}}}\n"
            f"  filter: {{cluster: {filtering}, script: quiet.py, subscribe: {{image: {TEXT}}},\n"
            f"    publish: {{small: {TEXT}}}}}\n"
            f"  sink: {{cluster: {sink}, script: quiet.py, subscribe: {{small: {TEXT}}}}}\n"
        )
        path = tmp_path / "map.yaml"
        path.write_text(text + more)
        return path

    return write


def facts(path: Path, trace: Trace | None = None) -> Facts:
    return facts_of(check(path), trace)


def with_events(trace: Trace, cluster: int, rows: list) -> Trace:
    """Add events to the node of a cluster."""

    def changed(process: Process) -> Process:
        if process.cluster != cluster or process.is_receive_thread:
            return process
        thread = process.threads[0]
        events = np.concatenate([thread.events, np.array(rows, EVENT)])
        ordered = events[np.argsort(events["time_ns"], kind="stable")]
        return replace(process, threads=(replace(thread, events=ordered),))

    return replace(trace, processes=tuple(map(changed, trace.processes)))


@pytest.mark.parametrize(
    ("clusters", "crossings", "words"),
    [
        ((1, 1, 1), [], "none of 2 topics crosses clusters"),
        ((1, 1, 2), [("/small", 1, 2)], "1 of 2 topics crosses clusters"),
        ((1, 2, 3), [("/image", 1, 2), ("/small", 2, 3)], "both topics cross clusters"),
    ],
)
def test_topics_cross_without_a_trace(placed: Placed, clusters, crossings, words) -> None:
    found = facts(placed(*clusters))
    keys = [(one.topic, one.publisher_cluster, one.receiver_cluster) for one in found.crossings]
    assert keys == crossings
    assert words in verdict(found).split("; ")


def test_the_verdict_without_topics_and_with_one(tmp_path: Path) -> None:
    (tmp_path / "quiet.py").write_text(NODE)
    path = tmp_path / "map.yaml"
    path.write_text("nodes:\n  a: {cluster: 1, script: quiet.py}\n")
    assert "no topic is known" in verdict(facts(path))
    one = f"nodes:\n  a: {{cluster: 1, script: quiet.py, publish: {{t: {TEXT}}}}}\n"
    path.write_text(one)
    assert "none of 1 topic crosses clusters" in verdict(facts(path))
    assert "not counted: 1 topic whose size is not known" in verdict(facts(path))
    path.write_text(f"{one}  b: {{cluster: 2, script: quiet.py, subscribe: {{t: {TEXT}}}}}\n")
    assert "the only topic crosses clusters" in verdict(facts(path))


def test_a_topic_of_the_bridge_crosses(placed: Placed) -> None:
    more = f"  viewer: {{cluster: 4, script: quiet.py, topic_to: {{small: {TEXT}}}}}\n"
    found = facts(placed(2, 2, 2, more))  # the bridge is in cluster 1
    assert [(one.topic, one.receiver_cluster) for one in found.crossings] == [("/small", 1)]


def test_nodes_whose_topics_are_computed_are_named(placed: Placed) -> None:
    path = placed(1, 1, 1, "  loud: {cluster: 2, script: computed.py}\n")
    assert verdict(facts(path)).endswith("the topics of /loud are not known without a trace")
    path = placed(1, 1, 1, f"  loud: {{cluster: 2, script: computed.py, publish: {{x: {TEXT}}}}}\n")
    assert "without a trace" not in verdict(facts(path))


def test_rates_of_a_trace_at_other_places(placed: Placed) -> None:
    """The trace has each node in a cluster of its own."""
    found = facts(placed(4, 4, 5), example())
    (crossing,) = found.crossings
    assert crossing.topic == "/small"
    assert (crossing.publisher_cluster, crossing.receiver_cluster) == (4, 5)
    assert (crossing.messages, crossing.size_bytes) == (ROUNDS, ROUNDS * MESSAGE_BYTES)
    assert found.traced is not None
    seconds = found.traced.recorded.seconds
    assert seconds == pytest.approx((ROUNDS * 10_000 + 135 - 10_002) / 1e6)
    assert found.per_s(crossing.messages) == pytest.approx(ROUNDS / seconds)
    (thread,) = found.traced.receive_threads
    assert (thread.cluster, thread.messages_per_s) == (5, pytest.approx(ROUNDS / seconds))
    assert found.growing == {"/image": MESSAGE_BYTES, "/small": MESSAGE_BYTES}
    assert "1 of 2 topics crosses clusters, 114.1 messages/s and 6.684 KiB/s" in verdict(found)


def test_topics_that_only_the_trace_knows_cross(placed: Placed, tmp_path: Path) -> None:
    path = tmp_path / "map.yaml"
    placed(1, 1, 1)
    nodes = {"camera": 1, "filter": 2, "sink": 2}
    lines = [f"  {name}: {{cluster: {n}, script: computed.py}}\n" for name, n in nodes.items()]
    path.write_text("nodes:\n" + "".join(lines))
    assert len(facts(path).unknown) == 3
    found = facts(path, example())
    assert [(one.topic, one.messages) for one in found.crossings] == [("/image", ROUNDS)]
    assert found.topics == {"/image", "/small"}
    assert found.unknown == ()


def test_a_rate_begins_when_the_last_node_waits_for_work(placed: Placed) -> None:
    """A node that starts again is not the last one."""
    started = starting(example(), until_us=45_000)
    early = next(one for one in started.processes if one.cluster == 3)
    again = np.array([event(75_000, Kind.JOIN, NO_ENDPOINT), *wait(76_000, 77_000)], EVENT)
    second = replace(early, pid=99, threads=(Thread(99, "python", again, 0),))
    trace = replace(started, processes=(*started.processes, second))
    assert Recorded.of(trace).begin_ns == 49_900 * US
    (crossing,) = facts(placed(1, 2, 2), trace).crossings
    assert crossing.messages == 4  # at 50, 60, 70 and 80 ms


def test_a_load_is_without_the_time_in_which_nodes_start() -> None:
    """The sink takes all of a CPU to start, and a quarter of one then."""
    trace = starting(example(), until_us=45_000)
    used_us = {1: 0, 49_900: 49_900, 89_900: 59_900}
    rows = [event(at, Kind.CPU, NO_ENDPOINT, 0, used * US) for at, used in used_us.items()]
    loads = {one.nodes: one.cpu_share for one in Recorded.of(with_events(trace, 3, rows)).loads()}
    assert loads["/sink",] == pytest.approx(0.25)


def test_a_node_that_never_waits_has_started_when_it_joined() -> None:
    joined = with_events(example(), 1, [event(45_000, Kind.JOIN, NO_ENDPOINT)])
    assert Recorded.of(joined).begin_ns == 45_000 * US


def test_nodes_that_ran_before_the_trace_do_not_delay_its_begin() -> None:
    """Their first wait may come late: until then they sleep in an earlier one."""
    assert Recorded.of(example()).begin_ns == 10_002 * US


def test_a_rate_ends_before_nodes_log_their_end(placed: Placed) -> None:
    trace = with_events(example(), 1, publish(900_000, LOG, 1))
    named = Endpoint(True, "topic", "/rosout", "rcl_interfaces/msg/Log", "/camera", 1)
    trace = replace(trace, endpoints={**trace.endpoints, endpoint_id(LOG, INCARNATION): named})
    assert Recorded.of(trace).seconds == Recorded.of(example()).seconds
    only = replace(trace, endpoints={endpoint_id(LOG, INCARNATION): named})
    assert Recorded.of(only).end_ns == 900_002 * US  # better than nothing


@pytest.mark.parametrize(
    ("of_filter", "words"),
    [
        (0.5, "the busiest core is cluster 1 core 3 with 75% of a CPU"),
        (0.9, "cluster 1 core 3 is overloaded with 115% of a CPU"),
    ],
)
def test_loads_are_those_of_cores_in_the_mapfile(
    placed: Placed, of_filter: float, words: str
) -> None:
    """CPU time is sampled, counts on, and is interpolated at both ends."""
    trace = example()
    begin, end = Recorded.of(trace).begin_ns // US, Recorded.of(trace).end_ns // US
    samples = {1: 0.25, 2: of_filter}
    for cluster, share in samples.items():
        rows = [
            event(at, Kind.CPU, NO_ENDPOINT, 0, int(7_000_000 + share * (at - begin) * US))
            for at in (begin - 5000, begin + 13, end + 5000)
        ]
        trace = with_events(trace, cluster, rows)
    path = placed(1, 1, 2)
    both = path.read_text().replace("{cluster: 1,", "{cluster: 1, core: 3,")
    path.write_text(both.replace("nodes:", "allow_shared_cores: true\nnodes:"))
    found = facts(path, trace)
    assert found.traced is not None
    shares = {(c.core.cluster, c.core.core): (c.nodes, c.cpu_share) for c in found.traced.cores}
    assert shares == {
        (1, 3): (("/camera", "/filter"), pytest.approx(0.25 + of_filter, abs=1e-3)),
        (2, 1): (("/sink",), 0.0),
    }
    assert words in verdict(found).split("; ")


def test_memory_of_the_trace_is_that_of_the_same_clusters(placed: Placed) -> None:
    rows = [event(at, Kind.SMEM, NO_ENDPOINT, 2, kib << 10) for at, kib in ((1, 9), (2, 70))]
    trace = with_events(example(), 1, rows)
    same, other = facts(placed(1, 2, 3), trace).traced, facts(placed(1, 2, 2), trace).traced
    assert same is not None
    assert other is not None
    assert same.peak_smem_bytes == {2: 70 << 10}
    assert other.peak_smem_bytes == {}


def test_a_trace_of_other_nodes_is_refused(placed: Placed) -> None:
    path = placed(1, 1, 1)
    path.write_text(path.read_text().replace("  camera", "  a").replace("  filter", "  b"))
    path.write_text(path.read_text().replace("  sink", "  c"))
    with pytest.raises(
        ManycoreError, match="none of the mapfile's nodes: record one with"
    ) as error:
        facts(path, example())
    assert error.value.exit_status == EXIT_BAD_INPUT


def test_nodes_that_are_not_in_the_trace_are_named(placed: Placed) -> None:
    found = facts(placed(1, 1, 1, "  late: {cluster: 2, script: quiet.py}\n"), example())
    assert verdict(found).endswith("the trace has no message of /late")


def test_a_trace_without_a_message_is_refused() -> None:
    with pytest.raises(ManycoreError, match="has no published message: trace for longer"):
        Recorded.of(Trace("test", (), {}, 0))


def test_crossings_are_those_counted_message_by_message() -> None:
    for seed in range(50):
        chosen = random.Random(seed)
        topics = [f"/t{i}" for i in range(5)]
        publications = [
            Publication(
                *(chosen.choice(topics), chosen.randint(1, 4)),
                *(chosen.randint(0, 9), chosen.randint(0, 999)),
            )
            for _ in range(12)
        ]
        subscriptions = [(chosen.choice(topics), chosen.randint(1, 4)) for _ in range(8)]
        expected: dict[tuple[str, int, int], list[int]] = {}
        for one in publications:
            for cluster in range(1, 5):
                if (one.topic, cluster) in subscriptions and cluster != one.cluster:
                    sums = expected.setdefault((one.topic, one.cluster, cluster), [0, 0])
                    sums[0] += one.messages
                    sums[1] += one.size_bytes
        traffic = Traffic.of(publications, subscriptions)
        found = {
            (one.topic, one.publisher_cluster, one.receiver_cluster): [one.messages, one.size_bytes]
            for one in traffic.crossings()
        }
        assert found == expected
        leaving = {key[:2] for key in expected}
        assert traffic.leaving_messages == sum(
            one.messages for one in publications if (one.topic, one.cluster) in leaving
        )


def manycore(*words: str | Path) -> Result:
    return CliRunner().invoke(cli, [*map(str, words)], prog_name="manycore")


def saved(trace: Trace, path: Path) -> Path:
    save(trace, path)
    return path


def test_check_and_show_have_the_same_figures(placed: Placed, tmp_path: Path) -> None:
    path, trace = placed(1, 2, 2), saved(example(), tmp_path / "trace.json")
    answers = [json.loads(manycore("map", verb, path, "--trace", trace, "--json").stdout)
               for verb in ("check", "show")]  # fmt: skip
    assert answers[0]["mapping"] == answers[1]["mapping"]
    assert answers[0]["clusters"] == answers[1]["clusters"]
    mapping = answers[0]["mapping"]
    assert (mapping["topics"], mapping["crossing_topics"]) == (2, 1)
    assert mapping["crossings"] == [
        {
            "topic": "/image",
            "publisher_cluster": 1,
            "receiver_cluster": 2,
            "messages_per_s": mapping["messages_per_s"],
            "bytes_per_s": mapping["bytes_per_s"],
        }
    ]
    assert mapping["messages_per_s"] * mapping["trace"]["duration_s"] == pytest.approx(ROUNDS)
    for verb in ("check", "show"):
        text = manycore("map", verb, path, "--trace", trace).stdout
        assert f"verdict: {mapping['verdict']}" in text.splitlines()


def test_show_has_a_table_of_what_crosses(placed: Placed, tmp_path: Path) -> None:
    path, trace = placed(1, 2, 2), saved(example(), tmp_path / "trace.csv")
    lines = [line.split() for line in manycore("map", "show", path).stdout.splitlines()]
    assert ["/image", "1", "2"] in lines
    assert not any("load" in line for line in lines)
    lines = [
        line.split() for line in manycore("map", "show", path, "--trace", trace).stdout.splitlines()
    ]
    assert ["/image", "1", "2", "114.1", "6.684", "KiB"] in lines
    assert ["2", "receive", "thread", "114.1", "0.0%"] in lines
    known = "with messages up to 60 B: /image, /small"
    assert f"not counted, 2 topics {known}".split() in lines


def test_a_trace_that_lost_events_is_named(placed: Placed, tmp_path: Path) -> None:
    path = placed(1, 1, 1)
    result = manycore("map", "check", path, "--trace", saved(example(), tmp_path / "t.json"))
    assert f"{tmp_path}/t.json lacks 7 events, so rates are too low" in result.stderr


def test_a_trace_that_cannot_be_read_is_one_line(placed: Placed, tmp_path: Path) -> None:
    result = manycore("map", "check", placed(1, 1, 1), "--trace", tmp_path / "none.json")
    assert result.exit_code == 1
    assert "none.json: cannot be read: No such file or directory" in result.output
