# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Predictions of made profiles, whose times follow by hand."""

from __future__ import annotations

import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.prediction import TARGETS, Prediction, Sites, Target, predict
from rmw_manycore_py.prediction.events import START_NS
from rmw_manycore_py.profile.model import Node, Process, Profile
from rmw_manycore_py.trace.chains import Messages
from rmw_manycore_py.trace.events import Kind, endpoint_id
from support.samples.profiles import (
    MS,
    NODES,
    TOPICS,
    callback,
    pipeline,
    publishes,
    sites,
    steady,
)

pytestmark = pytest.mark.unit

# Messages cost nothing, so that times follow from the callbacks alone.
FREE = TARGETS["host"].changed(
    dict.fromkeys(("wake_us", "wake_busy_us", "publish_us", "receive_us", "switch_us"), 0),
    "chosen",
)


def run(profile: Profile, target: Target = FREE, **options: object) -> Prediction:
    """Predict ten seconds of the pipeline, its nodes on CPUs of their own by default."""
    options.setdefault("sites", sites())
    return predict(profile=profile, target=target, duration_s=10.0, **options)


def total_us(prediction: Prediction) -> tuple[float | None, float | None]:
    (chain,) = prediction.chains
    assert chain.name == "/image (/filter) > /small (/sink)"
    return chain.quantile_us(0.5), chain.quantile_us(1.0)


def test_a_chain_takes_what_its_callbacks_take() -> None:
    prediction = run(pipeline())
    assert total_us(prediction) == pytest.approx((20_000, 20_000), abs=0.1)
    assert prediction.chains[0].row()["count"] == pytest.approx(100, abs=1)


def test_loads_are_rates_times_cpu_times() -> None:
    loads = {one.nodes[0]: one.cpu_share for one in run(pipeline()).cores}
    assert loads == pytest.approx({"/camera": 0.02, "/filter": 0.3, "/sink": 0.01}, abs=0.004)


def test_a_host_cpu_has_the_load_of_all_that_run_on_it() -> None:
    target = FREE.changed({"receive_us": 500.0}, "chosen")
    prediction = run(pipeline(), target, sites=sites(1, 2, 2, host_cpus=(0, 0, 1)))
    loads = {one.cpu: one.cpu_share for one in prediction.cpus}
    assert loads == pytest.approx({0: 0.32, 1: 0.01, 3: 0.005}, abs=0.004)
    assert prediction.busiest == loads[0]
    chip = run(pipeline(), TARGETS["coolidge"])
    assert not chip.cpus
    assert chip.busiest == max(one.cpu_share for one in chip.cores)


def test_a_slower_cpu_takes_longer() -> None:
    assert total_us(run(pipeline(), FREE.changed({"speed": 0.5}, "chosen")))[0] == pytest.approx(
        40_000, abs=0.1
    )


@pytest.mark.parametrize("first", [0, 1])
def test_timers_that_are_due_together_go_in_the_order_of_the_mapfile(first: int) -> None:
    timers = pipeline(
        callbacks=(
            callback(0, 2, kind="timer", period_ns=100 * MS, publishes=publishes(0, 1)),
            callback(1, 2, kind="timer", period_ns=50 * MS, publishes=publishes(1, 1)),
        )
    )
    places = sites(host_cpus=(0, 0, 0)).nodes
    ordered = Sites(dict(sorted(places.items(), key=lambda one: one[0] != NODES[first])))
    trace = run(timers, sites=ordered, is_traced=True, timers_together=True).trace
    assert trace is not None
    written = sorted(
        (time_ns, trace.topic_of(endpoint_id(slot, incarnation)))
        for _, thread in trace.threads()
        for time_ns, _, _, slot, incarnation, kind in thread.events.tolist()
        if kind == Kind.WRITE and time_ns >= START_NS + 100 * MS
    )
    assert [topic for _, topic in written[:2]] == [TOPICS[first], TOPICS[1 - first]]


def test_what_a_timer_publishes_has_no_cause_though_its_thread_did_not_sleep() -> None:
    """The filter's timer is due at 150 ms, while it handles an image, from 101 to 161 ms."""
    busy = pipeline(
        callbacks=(
            callback(0, 2, kind="timer", period_ns=100 * MS, publishes=publishes(0, 1)),
            callback(1, 60, trigger="/image", subscription=0),
            callback(1, 1, kind="timer", period_ns=50 * MS, publishes=publishes(1, 0.5)),
            callback(2, 1, trigger="/small", subscription=1),
        )
    )
    trace = run(busy, is_traced=True, timers_together=True).trace
    assert trace is not None
    messages = Messages(trace)
    assert len(messages.arrivals["/small"]) > 100
    assert not messages.causes


def test_a_shared_cpu_delays() -> None:
    """Camera and filter on one CPU: the camera runs on for 1 ms when the filter could begin."""
    prediction = run(pipeline(), sites=sites(host_cpus=(0, 0, 1)))
    assert total_us(prediction)[0] == pytest.approx(21_000, abs=0.1)


def test_a_receive_thread_costs_its_time_between_clusters() -> None:
    target = FREE.changed({"receive_us": 500.0}, "chosen")
    prediction = run(pipeline(), target, sites=sites(1, 2, 2))
    assert total_us(prediction)[0] == pytest.approx(20_500, abs=0.1)
    (thread,) = prediction.receive_threads
    assert (thread.cluster, thread.messages_per_s) == (2, pytest.approx(10, abs=0.2))


@pytest.mark.parametrize(
    ("clusters", "first"),
    [
        ((1, 3, 2), "/sink"),
        ((1, 2, 3), "/filter"),
        ((3, 3, 1), "/filter"),
        ((3, 1, 3), "/sink"),
        ((2, 1, 1), "/filter"),
        ((1, 1, 1), "/filter"),
    ],
    ids=lambda value: value if isinstance(value, str) else "-".join(map(str, value)),
)
def test_readers_on_one_cpu_run_in_the_order_of_their_notification(
    clusters: tuple[int, int, int], first: str
) -> None:
    """Those of the own cluster first, then the other clusters by number."""
    camera, filtering, sink = pipeline().callbacks
    both = pipeline(
        callbacks=(camera, filtering, sink.model_copy(update={"trigger": "/image"})),
        subscriptions=tuple(
            one.model_copy(update={"topic": "/image"}) for one in pipeline().subscriptions
        ),
    )
    prediction = run(both, sites=sites(*clusters, host_cpus=(0, 1, 1)))
    waits_ms = {one.node: one.p50_us / 1e3 for one in prediction.communications}
    other = {"/filter": "/sink", "/sink": "/filter"}[first]
    assert waits_ms[first] == pytest.approx(0, abs=0.1)
    assert waits_ms[other] > 0.9  # the sink's callback takes 1 ms, a slice is 2.8 ms


def test_messages_that_a_full_queue_drops_leave_the_topic_dsm() -> None:
    """The filter takes 150 ms for an image of 1000 bytes each 100 ms, and has a queue for two."""
    camera, _, sink = pipeline().callbacks
    slow = callback(1, 150, trigger="/image", subscription=0, publishes=publishes(1, 20))
    prediction = run(pipeline(callbacks=(camera, slow, sink)))
    assert prediction.lost > 20
    assert prediction.smem_bytes[1] <= 6_000


def test_what_follows_a_callback_is_load_and_delays_the_next_one() -> None:
    """The sink has 100 ms for a message: it keeps up with a rest of 90 ms, not with 110."""
    loads, lost = [], []
    for rest_ms in (90, 110):
        processes = [Process(name=name[1:], threads=1, rest_ns=0.0) for name in NODES[:2]]
        processes.append(Process(name="sink", threads=1, rest_ns=rest_ms * MS))
        prediction = run(pipeline(processes=tuple(processes)))
        loads.append(next(one.cpu_share for one in prediction.cores if one.nodes == ("/sink",)))
        lost.append(sum(one.lost for one in prediction.queues))
    assert loads == pytest.approx([0.91, 1.0], abs=0.02)
    assert lost == [0, pytest.approx(7, abs=3)]


def test_a_receive_thread_has_the_cpu_time_of_the_profile() -> None:
    target = FREE.changed({"receive_us": 500.0}, "chosen")
    prediction = run(pipeline(receive_ns=3 * MS), target, sites=sites(1, 2, 2))
    assert total_us(prediction)[0] == pytest.approx(20_500, abs=0.1)
    (thread,) = prediction.receive_threads
    assert thread.cpu_share == pytest.approx(0.03, abs=0.001)


def test_a_full_queue_loses_the_oldest() -> None:
    """The filter takes 150 ms and keeps two of the messages that come each 100 ms."""
    slow = callback(1, 150, trigger="/image", subscription=0, publishes=publishes(1, 150))
    profile = pipeline()
    profile = pipeline(callbacks=(profile.callbacks[0], slow, profile.callbacks[2]))
    prediction = run(profile)
    (queue,) = prediction.queues
    assert (queue.node, queue.depth, queue.longest) == ("/filter", 2, 2)
    assert queue.lost == pytest.approx(100 - 100 / 1.5 - 2, abs=2)


def test_a_late_timer_skips() -> None:
    profile = pipeline()
    slow = callback(0, 150, kind="timer", period_ns=100 * MS, publishes=publishes(0, 1))
    (timer,) = run(pipeline(callbacks=(slow, *profile.callbacks[1:]))).timers
    assert (timer.node, timer.missed) == ("/camera", pytest.approx(33, abs=2))


def test_the_same_seed_gives_the_same_run() -> None:
    found = [run(pipeline(), seed=seed, sites=sites(1, 2, 3)) for seed in (1, 1, 2)]
    assert found[0] == found[1] != found[2]


def test_nodes_that_wait_for_all_inputs_publish_at_the_last() -> None:
    """The sink publishes at the later of two inputs, once per pair."""
    profile = pipeline()
    inputs = [
        callback(2, 1, trigger=topic, publishes=publishes(2, 1, count))
        for topic, count in (("/image", 40), ("/small", 60))
    ]
    output = profile.publishers[0].model_copy(update={"node": 2, "topic": "/fused"})
    reader = callback(1, 1, trigger="/fused")
    joined = pipeline(
        publishers=(*profile.publishers, output),
        callbacks=(*profile.callbacks[:2], *inputs, reader),
    )
    counts = {one.name.split(" (")[0]: one.row()["count"] for one in run(joined).chains}
    chains = [one for one in run(joined).chains if one.name.endswith("/fused (/filter)")]
    assert len(chains) == 1, counts  # /small comes last, always
    assert chains[0].row()["count"] == pytest.approx(100, abs=2)


def test_a_profile_of_another_application_is_refused() -> None:
    profile = pipeline(nodes=(*(Node(name=n, process=None) for n in (*NODES[:2], "/other")),))
    with pytest.raises(ManycoreError, match="does not place /other"):
        run(profile)


def test_sizes_count_in_smem() -> None:
    profile = pipeline()
    large = [one.model_copy(update={"size_bytes": steady(5000)}) for one in profile.publishers]
    assert run(pipeline(publishers=tuple(large))).smem_bytes == {1: 10_000}
