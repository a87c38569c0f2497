# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Callbacks of nodes in virtual time take as long as the simulator says; time stops when asked."""

from __future__ import annotations

import json
import signal
import sys
from itertools import pairwise
from pathlib import Path

import pytest
import yaml

from rmw_manycore_py.bench.session import program_path
from rmw_manycore_py.mapfile import load_mapfile, resolve
from rmw_manycore_py.papers.reference_system.bench.system import NATIVE
from rmw_manycore_py.prediction import predict, sites_of
from rmw_manycore_py.prediction.target_file import target_named
from rmw_manycore_py.profile.files import save
from rmw_manycore_py.trace.events import Kind
from rmw_manycore_py.trace.files import load
from support import IS_MANYCORE
from support.nodes import timed
from support.peers.programs import forked_manycore
from support.samples.profiles import pipeline

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

MAPFILE = """
platform: coolidge
allow_shared_cores: true
nodes:
  camera: {{command: [{node}, camera], cluster: 1, core: 1}}
  filter: {{command: [{node}, filter], cluster: {cluster}, core: 1}}
  sink: {{command: [{node}, sink], cluster: 1, core: 2}}
"""
# The camera publishes 1 ms after its begin; the prediction counts from there.
BEFORE_US = 1000
# Cluster of the filter, and speed of the cores. In cluster 1 it shares a core with the camera.
CASES = {"across": (2, 1.0), "shared": (1, 1.0), "slow": (2, 0.5)}


@pytest.mark.parametrize("case", CASES)
def test_a_chain_takes_the_simulated_time(case: str, tmp_path: Path, start) -> None:
    cluster, speed = CASES[case]
    mapfile, profile, platform = (tmp_path / name for name in ("map.yaml", "p.json", "target.yaml"))
    node = f"{sys.executable}, {timed.__file__}"
    mapfile.write_text(MAPFILE.format(node=node, cluster=cluster))
    save(pipeline(), profile)
    parameters = f"{{speed: {{value: {speed}, source: chosen}}}}"
    platform.write_text(f"base: coolidge\nparameters: {parameters}")
    model = ("--profile", profile, "--platform", platform)
    run = start(forked_manycore("run", mapfile, "--virtual", *model, "--duration", "2", "--json"))
    run.wait_for(r'"event": "finished"')
    assert run.wait() == 0
    events = map(json.loads, run.output.splitlines())
    found_us = [float(one["line"]) for one in events if one["event"] == "output"]
    assert len(found_us) == 19
    predicted = predict(
        sites_of(resolve(load_mapfile(mapfile))),
        pipeline(),
        target_named(str(platform)),
        duration_s=2.0,
        chains=[("/image", "/small")],
    )
    expected_us = predicted.chains[0].quantile_us(0.5) + BEFORE_US / speed
    assert found_us == pytest.approx([expected_us] * 19, rel=0.001)


def test_a_profile_of_another_application_is_refused(tmp_path: Path, manycore) -> None:
    mapfile, profile = tmp_path / "map.yaml", tmp_path / "p.json"
    mapfile.write_text("nodes: {other: {cluster: 1, command: ['true']}}")
    save(pipeline(), profile)
    text = manycore("run", mapfile, "--profile", profile, "--duration", "1", status=2)
    assert "manycore: the mapfile does not place /camera, which is in the profile" in text
    assert "started" not in text


def test_the_bench_compares_chains_with_the_simulator(tmp_path: Path, manycore) -> None:
    mapfile, profile, platform = (tmp_path / name for name in ("map.yaml", "p.json", "target.yaml"))
    platform.write_text("base: coolidge\nparameters: {speed: {value: 1, source: chosen}}\n")
    mapfile.write_text(MAPFILE.format(node=f"{sys.executable}, {timed.__file__}", cluster=2))
    save(pipeline(), profile)
    model = ("--profile", profile, "--platform", platform, "--chains")
    text = manycore("bench", "virtual", mapfile, *model, "--runs", "2", "--duration", "2", "--json")
    (chain,) = json.loads(text)["chains"]
    assert chain["name"] == "/image (/filter) > /small (/sink)"
    assert chain["virtual_us"] == pytest.approx(chain["simulated_us"], rel=0.001)


def test_timers_of_native_nodes_are_not_late(tmp_path: Path, manycore) -> None:
    """Those of rclpy wait twice after a callback, these once."""
    kinds = {"camera": ("sensor", "", "/image"), "filter": ("transform", "/image", "/small")}
    nodes = {}
    for name, (kind, inputs, outputs) in {**kinds, "sink": ("command", "/small", "")}.items():
        words = (
            *(f"name={name}", f"kind={kind}", f"inputs={inputs}", f"outputs={outputs}"),
            *("period_ms=100", "crunch_us=0", "message=manycore_reference_msgs/msg/Message4kb"),
            *("payload=untouched", "depth=10", "report_period_ms=1000"),
        )
        node = f"exec {program_path(NATIVE)} {' '.join(words)} parent=$PPID"
        nodes[name] = {"command": ["sh", "-c", node], "cluster": 1, "ros_arguments": False}
    mapfile, profile, trace = (tmp_path / name for name in ("map.yaml", "p.json", "trace.csv"))
    mapfile.write_text(yaml.safe_dump({"platform": "coolidge", "nodes": nodes}))
    save(pipeline(), profile)
    model = ("--profile", profile, "--platform", "coolidge")
    manycore("run", mapfile, "--virtual", *model, "--duration", "1", "--trace", trace)
    written_ns = [
        time_ns
        for process, thread in load(trace).threads()
        for time_ns, *_, kind in thread.events.tolist()
        if process.core == 1 and kind == Kind.WRITE
    ]
    assert len(written_ns) == 9
    intervals_ns = [later - earlier for earlier, later in pairwise(written_ns)]
    assert intervals_ns == pytest.approx([100_000_000] * 8, abs=10_000)  # the first one: a switch


def test_time_stands_and_goes_on_when_asked(tmp_path: Path, start, manycore) -> None:
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(MAPFILE.format(node=f"{sys.executable}, {timed.__file__}", cluster=1))
    run = start(forked_manycore("run", mapfile, "--virtual", "--instant"))
    run.wait_for("sink.*0.0")
    assert "s: paused" in manycore("pause")

    def stopped_at_s(*options: str) -> float:
        text = manycore("step", *options)
        return float(text.partition("time stands at ")[2].partition(" s: ")[0])

    published_s = stopped_at_s("--topic", "/image")
    assert published_s == pytest.approx(round(published_s, 1))
    assert stopped_at_s("--for", "0.05") == pytest.approx(published_s + 0.05)
    assert stopped_at_s() <= published_s + 0.1 + 1e-6
    assert stopped_at_s("--topic", "/small", "--for", "0.01") <= published_s + 0.11
    manycore("resume")
    manycore("stop")
    assert run.wait() == 0


@pytest.mark.parametrize(
    ("number", "step"),
    [(signal.SIGINT, ("--for", "1e6")), (signal.SIGKILL, ("--topic", "/nothing"))],
)
def test_time_stands_when_the_client_of_a_step_leaves(
    number: signal.Signals, step: tuple[str, ...], tmp_path: Path, start, manycore
) -> None:
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(MAPFILE.format(node=f"{sys.executable}, {timed.__file__}", cluster=1))
    run = start(forked_manycore("run", mapfile, "--virtual", "--instant"))
    run.wait_for("sink.*0.0")
    manycore("pause")
    run.wait_for("time stands at .*: paused")
    run.skip_output()
    client = start(forked_manycore("step", *step))
    run.wait_for("sink.*0.0")
    client.signal(number)
    client.wait()
    run.wait_for("time stands at .*: paused")
    manycore("stop")
    assert run.wait() == 0
