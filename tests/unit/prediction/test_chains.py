# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Chains and traces of predictions; reports of CARET."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from rmw_manycore_py.bench.predict import reports
from rmw_manycore_py.errors import FileError, ManycoreError
from rmw_manycore_py.mapfile.mapping.recorded import Recorded
from rmw_manycore_py.prediction import TARGETS, predict
from rmw_manycore_py.prediction.attribution import attributed
from rmw_manycore_py.prediction.events import START_NS
from rmw_manycore_py.prediction.target_file import target_named
from rmw_manycore_py.profile.caret import import_report
from rmw_manycore_py.profile.model import Chain, Hop
from rmw_manycore_py.trace.chains import Messages
from rmw_manycore_py.trace.files import load, save
from rmw_manycore_py.trace.latency import TOTAL, latencies
from support.samples.profiles import MS, callback, pipeline, publishes, sites

pytestmark = pytest.mark.unit

HOST = TARGETS["host"]


@pytest.mark.parametrize("suffix", [".json", ".csv"])
def test_the_trace_agrees_with_the_prediction(tmp_path: Path, suffix: str) -> None:
    prediction = predict(sites(1, 2, 3), pipeline(), HOST, duration_s=10, is_traced=True)
    assert prediction.trace is not None
    save(prediction.trace, tmp_path / f"trace{suffix}")
    trace = load(tmp_path / f"trace{suffix}")
    messages = Messages(trace)
    (found,) = latencies(messages, messages.chains)
    (chain,) = prediction.chains
    assert found.name == chain.name
    (total,) = (part for part in found.parts if part.name == TOTAL)
    assert total.samples_us == pytest.approx(chain.samples_us, abs=0.01)
    assert len(total.samples_us) == pytest.approx(100, abs=1)
    assert {one.label for one in trace.processes} >= {"camera", "filter", "sink"}


def test_the_trace_has_loads() -> None:
    prediction = predict(sites(1, 2, 3), pipeline(), HOST, duration_s=10, is_traced=True)
    assert prediction.trace is not None
    recorded = Recorded.of(prediction.trace)
    assert recorded.begin_ns == START_NS  # all nodes wait from the begin on
    loads = {one.nodes: one.cpu_share for one in recorded.loads()}
    assert loads["/filter",] == pytest.approx(0.3, abs=0.02)


def test_a_named_chain_waits_for_the_timer_that_publishes() -> None:
    """The filter stores images; its timer of 10 ms publishes the latest one once."""
    profile = pipeline()
    stores = callback(1, 0.5, trigger="/image", subscription=0)
    timer = callback(
        1, 1, kind="timer", period_ns=10 * MS, rate_hz=100.0, executions=1000,
        publishes=publishes(1, 1, 1000),
    )  # fmt: skip
    hops = (
        Hop(node=0, subscribes=None, publishes="/image"),
        Hop(node=1, subscribes="/image", publishes="/small"),
        Hop(node=2, subscribes="/small", publishes=None),
    )
    named = pipeline(
        callbacks=(profile.callbacks[0], stores, profile.callbacks[2], timer),
        chains=(Chain(name="through", hops=hops),),
    )
    free = HOST.changed(dict.fromkeys(("wake_us", "wake_busy_us", "switch_us"), 0), "chosen")
    (chain,) = predict(sites(), named, free, duration_s=10).chains
    assert chain.name == "through"
    assert len(chain.samples_us) == pytest.approx(100, abs=2)
    # 1 ms in the camera, up to 10 ms until the timer, 1 ms in each of timer and sink.
    assert 3_000 <= (chain.quantile_us(0) or 0) <= (chain.quantile_us(1) or 0) <= 13_100


def test_a_publisher_without_callback_gets_the_one_with_its_rate() -> None:
    """Of two callbacks at the rate of the topic, the one that works publishes."""
    profile = pipeline()
    idle = callback(1, 0.01, trigger="/other")
    works = callback(1, 30, trigger="/image", subscription=0)
    slow = callback(1, 50, trigger="/slow", rate_hz=5.0)
    publishers = tuple(one.model_copy(update={"publications": None}) for one in profile.publishers)
    found = attributed(
        pipeline(
            publishers=publishers,
            callbacks=(profile.callbacks[0], idle, works, slow, profile.callbacks[2]),
        )
    )
    assert [[one.publisher for one in of.publishes] for of in found.callbacks] == [
        [0], [], [1], [], [],
    ]  # fmt: skip


def report(directory: Path) -> Path:
    """Write a report of two nodes, whose chain was measured with 7 ms."""
    statistic = "{avg: %s, min: %s, max: %s, p50: %s, p95: %s, p99: %s}"
    times = {"camera": (10.0, 2.0), "sink": (10.0, 3.0)}
    texts = []
    for name, (rate, ms) in times.items():
        numbers = [statistic % ((one,) * 6) for one in (rate, 1000 / rate, ms)]
        parts = zip(("Frequency", "Period", "Latency"), numbers, strict=True)
        texts.append(f"/{name}:\n  callbacks:\n    /{name}/callback_0:\n")
        texts += [f"      {key}: {text}\n" for key, text in parts]
    directory.mkdir()
    (directory / "stats_node.yaml").write_text("".join(texts))
    (directory / "stats_path.yaml").write_text("- {target_path_name: path, best_p50: 7.0}\n")
    (directory / "architecture.yaml").write_text(ARCHITECTURE)
    return directory


ARCHITECTURE = """
named_paths:
- path_name: path
  node_chain:
  - {node_name: /camera, publish_topic_name: /image, subscribe_topic_name: UNDEFINED}
  - {node_name: /sink, publish_topic_name: UNDEFINED, subscribe_topic_name: /image}
executors: []
nodes:
- node_name: /camera
  callback_groups: []
  callbacks:
  - {callback_name: /camera/callback_0, callback_type: timer_callback, period_ns: 100000000,
     symbol: a}
  publishes:
  - {topic_name: /image, callback_names: [/camera/callback_0]}
  subscribes: []
- node_name: /sink
  callback_groups: []
  callbacks:
  - {callback_name: /sink/callback_0, callback_type: subscription_callback, topic_name: /image,
     symbol: b}
  publishes: []
  subscribes:
  - {topic_name: /image, callback_name: /sink/callback_0}
"""


def test_a_report_is_predicted_without_its_answers(tmp_path: Path) -> None:
    """The same without stats_path.yaml, and with another one."""
    directory = report(tmp_path / "report")
    predicted = reports.predicted_chains(import_report(directory), 1)
    assert predicted["path"] == pytest.approx(5.0, abs=0.5)  # 2 and 3 ms, and a message
    answers = directory / reports.ANSWERS
    (chain,) = reports.reported_chains(directory, 1)
    assert (chain.measured_ms, chain.predicted_ms) == (7.0, predicted["path"])
    answers.write_text("- {target_path_name: path, best_p50: 70.0}\n")
    (chain,) = reports.reported_chains(directory, 1)
    assert chain.predicted_ms == predicted["path"]
    answers.unlink()
    assert reports.predicted_chains(import_report(directory), 1) == predicted
    with pytest.raises(FileError, match=reports.ANSWERS):
        reports.reported_chains(directory, 1)
    shutil.rmtree(directory)


def test_a_platform_comes_from_a_file(tmp_path: Path) -> None:
    path = tmp_path / "board.yaml"
    path.write_text(
        "base: coolidge\ncpus: shared\n"
        "parameters:\n  speed: {value: 0.5, source: measured here}\n"
        "  cpu_count: {value: 4, source: published}\n"
    )
    target = target_named(str(path))
    assert (target.name, target.cpus, target.speed, target.cpu_count) == ("board", "shared", 0.5, 4)
    assert "speed" not in target.unknown
    assert "wake_us" in target.unknown


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("base: mars", "base"),
        ("base: host\nspeed: 1", "speed"),
        ("base: host\nparameters: {sped: {value: 1, source: fitted}}", "parameter sped"),
        ("base: host\nparameters: {speed: {value: 0, source: fitted}}", "more than 0"),
        ("base: host\nparameters: {speed: {value: 1, source: guessed}}", "parameters.speed.source"),
        ("base: host\nparameters: {speed: {value: .nan, source: fitted}}", "speed.value"),
        ("base: 2026-99-99", "expected a platform"),
        ("[", "expected a platform"),
    ],
)
def test_a_wrong_platform_is_refused(tmp_path: Path, text: str, found: str) -> None:
    path = tmp_path / "board.yaml"
    path.write_text(text)
    with pytest.raises(ManycoreError, match=found):
        target_named(str(path))


def test_an_unknown_platform_is_refused() -> None:
    with pytest.raises(ManycoreError, match="expected host, coolidge, bostan, or a file"):
        target_named("mars")


def test_links_of_the_chip_carry_what_crosses_clusters() -> None:
    """From cluster 1 to 6 of Bostan a message passes C2; the eMCOS message counts, too."""
    bostan = TARGETS["bostan"].changed({"speed": 1.0}, "chosen")
    prediction = predict(sites(1, 6, 6), pipeline(), bostan, duration_s=10)
    found = {one.link: one.bytes_per_s for one in prediction.links}
    assert found == pytest.approx({("C1", "C2"): 10_640, ("C2", "C6"): 10_640}, rel=0.02)


def test_a_bus_that_is_slow_delays() -> None:
    bus = replace(HOST, network="bus").changed({"bytes_per_us": 0.1, "message_us": 1.0}, "chosen")
    near, far = (
        predict(places, pipeline(), bus, duration_s=10).chains[0].quantile_us(0.5)
        for places in (sites(1, 1, 1), sites(1, 2, 2))
    )
    # A message of 1000 bytes, and an eMCOS message of 64, at 10 us per byte.
    assert far - near == pytest.approx(10_640, abs=100)
