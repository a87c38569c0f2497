# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Every bench runs in its shortest form; no figure is compared with a limit.

What still takes half a minute of CPU time is marked `stress`, and what takes ten seconds `long`.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.bench.cameras import MIDDLEWARES, SMALL, detections
from rmw_manycore_py.bench.hosts import can_have_hosts
from rmw_manycore_py.profile.files import save
from support import TIMEOUT_S, wait_until
from support.processes.commands import manycore_command
from support.processes.platforms import PLATFORMS, entries
from support.samples.profiles import queued

pytestmark = pytest.mark.integration

LONG_S = 10 * TIMEOUT_S


def only(*parts: str) -> tuple[str, ...]:
    return tuple(word for part in parts for word in ("--only", part))


OWN = only("(block)")
FAST_DDS_AND_OURS = "Fast DDS + platform"
OTHERS = only("64 B: futex", "64 B: pipe", "64 B: Fast DDS", "1 MiB: Fast DDS")
RCLPY = only("64 B: manycore run", "8 MiB: manycore run, inside", "1 MiB: manycore inside (block)")
MACHINE = only("way", "copy", "64 B: same CPU, manycore inside")
COPIES = only("copies", "numpy: manycore", "asleep: manycore")
STARTUP = only("by hand: manycore inside", "set: manycore between")
SPLIT = only("1 derivatives, 2")
PIPELINE = only("1000 waypoints: session", "SMEM: left")
BRIDGE = only("trip 64 B", "throughput", "idle")


def run_bench(*arguments: str) -> dict[str, Any]:
    command = manycore_command("bench", *arguments, "--quick", "--json")
    bench = subprocess.Popen(
        [str(word) for word in command],
        env={**os.environ, "MANYCORE_PLATFORM": "untouched"},
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    try:
        output, errors = bench.communicate(timeout=LONG_S)
    finally:
        bench.kill()
    assert bench.returncode == 0, errors
    own = f"bench-{bench.pid}-*"
    wait_until(lambda: not entries(PLATFORMS, own), "no platform of the bench is left")
    report: dict[str, Any] = json.loads(output)
    assert report["results"]
    return report


def test_a_contender_that_does_not_exist_is_an_error() -> None:
    command = manycore_command("bench", "scale", "--quick", *only("no such contender"))
    bench = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S)
    assert bench.returncode == 2
    assert "--only 'no such contender' is in no QUESTION: CONTENDER" in bench.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        ("rmw", "round-trip", *OWN),
        ("rmw", "round-trip", *OTHERS),
        ("rmw", "first-message"),
        pytest.param(("copies", *COPIES), marks=pytest.mark.stress),
        ("fields",),
        ("rclpy", *RCLPY),
        ("startup", *STARTUP),
        ("memory", *OWN),
        pytest.param(("ros-lite", *SPLIT), marks=pytest.mark.stress),
        pytest.param(("ros-lite", *PIPELINE), marks=pytest.mark.stress),
    ],
    ids=[
        "round-trip",
        "round-trip-others",
        "first-message",
        "copies",
        "fields",
        "rclpy",
        "startup",
        "memory",
        "ros-lite",
        "ros-lite-pipeline",
    ],
)
def test_a_bench_measures_every_contender(arguments: tuple[str, ...]) -> None:
    for result in run_bench(*arguments)["results"]:
        assert result["samples"] > 0
        assert result["median"] > 0


def test_images_get_through_the_filter_to_the_detector() -> None:
    images = 8
    found = detections(SMALL, MIDDLEWARES[0], images)
    assert 0 < found.arrived <= images
    assert found.age_ms > 0
    assert found.cpu_s > 0


def all_reached(report: dict[str, Any]) -> bool:
    return all(goal["reached"] for goal in report["goals"]) and bool(report["goals"])


def comes_once(attempt: Callable[[], bool]) -> bool:
    """Return whether one of three attempts succeeds.

    For figures of a short window. Exactly 0: a process that was preempted on its way to sleep
    finishes that in the window. More than 0: beside a load, a process may get no CPU in it.
    """
    return any(attempt() for _ in range(3))


@pytest.mark.parametrize("question", ["throughput", "fan-out"])
def test_nothing_is_lost(question: str) -> None:
    report = run_bench("rmw", question, *OWN)
    lost = [row for row in report["results"] if row["question"].endswith("lost")]
    assert lost
    assert [row for row in lost if row["largest"] > 0] == []


def test_the_warm_data_path_neither_allocates_nor_faults() -> None:
    assert all_reached(run_bench("rmw", "steady-state", *OWN))


def test_idle_nodes_do_nothing() -> None:
    nodes = ("idle", "--nodes", "6", "--only", "manycore")
    assert comes_once(lambda: all_reached(run_bench(*nodes)))


def test_a_message_wakes_one_thread_of_many() -> None:
    report = run_bench("scale", "--only", "message to one of its threads: manycore")
    assert all_reached(report)
    waits = {"block", "adaptive", "spin"}
    notified = [row for row in report["results"] if row["question"].startswith("wake words")]
    assert {wait for row in notified for wait in waits if f"({wait})" in row["contender"]} == waits
    assert all(row["median"] >= 1 for row in notified)  # each message notifies its thread


def test_many_matches_are_measured() -> None:
    rows = run_bench("scale", "--only", "as many publishers: manycore")["results"]
    assert len({row["question"] for row in rows}) == 6
    assert {row["axis"] for row in rows} == {"endpoints"}
    assert all(row["median"] > 0 for row in rows)


@pytest.mark.long
def test_a_call_concerns_no_other_client() -> None:
    rows = run_bench("scale", "--only", "service with as many clients: manycore")["results"]
    contender = "manycore in 5 clusters (block), 25 clients"
    found = {row["question"]: row["median"] for row in rows if row["contender"] == contender}
    assert found.pop("a call to a service with as many clients") > 0
    assert found == {
        "sleeps of a service's other clients per call": 0,
        "CPU time of a service's other clients per call": 0,
    }


def test_a_goal_of_an_action_with_many_clients_is_measured() -> None:
    rows = run_bench("scale", "--only", "in rclpy: manycore")["results"]
    assert len(rows) == 3 * 2
    assert all(row["median"] > 0 for row in rows if "10 clients" in row["contender"])


def test_simulated_time_reaches_all_nodes() -> None:
    rows = run_bench("scale", "--only", "gets, at 1 kHz: manycore")["results"]
    assert {row["contender"] for row in rows} == {
        f"manycore in {place} (block), {nodes} nodes"
        for place in ("one cluster", "5 clusters")
        for nodes in (10, 25)
    }
    assert all(row["median"] > 0 for row in rows)
    seen = [row for row in rows if row["unit"] == "count"]
    assert {(row["samples"], row["largest"] <= 1000) for row in seen} == {(10, True), (25, True)}


def test_simulated_time_crosses_the_bridge() -> None:
    def is_received() -> bool:
        rows = run_bench("scale", "--only", "gets, at 1 kHz: Fast DDS, bridge")["results"]
        assert {row["samples"] for row in rows if row["unit"] == "count"} == {10, 25}
        return all(row["median"] > 0 for row in rows)

    assert comes_once(is_received)


@pytest.mark.stress
def test_simulated_time_moves_the_clocks_of_rclpy_nodes() -> None:
    rows = run_bench("scale", "--only", "node with use_sim_time per time it gets")["results"]
    assert {row["at"] for row in rows} == {5}
    assert len({row["curve"] for row in rows}) == 4
    assert all(row["median"] > 0 for row in rows)
    seen = [row for row in rows if row["unit"] == "1/s"]
    assert {(row["samples"], row["largest"] <= 1000) for row in seen} == {(5, True)}


def test_what_each_publisher_costs_a_subscription_is_measured() -> None:
    rows = run_bench("scale", "--only", "into all its publishers: manycore")["results"]
    assert len({row["question"] for row in rows}) == 2
    assert all(row["median"] > 0 for row in rows)
    bytes_of_matches = [row["median"] for row in rows if row["unit"] == "bytes"]
    assert bytes_of_matches
    assert min(bytes_of_matches) <= 200  # where their blocks are full


def test_publishing_beside_a_deep_history_is_measured() -> None:
    rows = run_bench("scale", "--only", "keeps a full history")["results"]
    assert {row["curve"] for row in rows} == {"manycore inside (block)", "Fast DDS as installed"}
    assert {(row["at"], row["axis"]) for row in rows} == {(n, "messages kept") for n in (1, 10)}
    assert all(row["median"] > 0 for row in rows)


@pytest.mark.stress
def test_composed_nodes_are_measured_with_each_executor() -> None:
    rows = run_bench("scale", "--only", "next in its process: manycore")["results"]
    assert len(rows) == 2 * 4 * 2
    assert any("one executor each" in row["contender"] for row in rows)
    assert all(row["median"] > 0 for row in rows)


@pytest.mark.long
def test_nodes_of_two_processes_are_measured_with_each_executor() -> None:
    rows = run_bench("scale", "--only", "to one of the other process: manycore")["results"]
    assert {row["at"] for row in rows} == {2, 10}
    assert len(rows) == 2 * 2 * 2
    assert all(row["median"] > 0 for row in rows)


@pytest.mark.stress
def test_nodes_do_not_wake_each_other() -> None:
    def sleep_on() -> bool:
        report = run_bench("scale", "--only", "until each topic has its subscription: manycore")
        found = {row["question"]: row["median"] for row in report["results"]}
        assert len(found) == 10
        contenders = {row["contender"] for row in report["results"]}
        for beside in ("its graph read", "manycore node list"):
            assert any(beside in contender for contender in contenders)
        assert found["publishing on one of their topics"] > 0
        sleeps = found["sleeps of all others per node that joins"]
        return sleeps == found["CPU time of all when nothing happens"] == 0

    assert comes_once(sleep_on)


@pytest.mark.long
def test_the_skeleton_of_a_profile_is_measured(tmp_path: Path) -> None:
    save(queued(100), tmp_path / "profile.json")
    rows = run_bench("autoware", str(tmp_path / "profile.json"), "--only", "manycore")["results"]
    assert {row["at"] for row in rows} == {1, 3}
    medians = {row["question"]: row["median"] for row in rows if row["at"] == 3}
    assert len(medians) == 14
    assert medians["messages lost"] == 0
    silent = {"messages lost", "wake-ups of all at rest", "CPU time of all at rest"}
    assert all(median > 0 for question, median in medians.items() if question not in silent)


@pytest.mark.stress
def test_scan_matching_is_measured_alone_and_split() -> None:
    report = run_bench("ndt", "--only", "rmw_manycore")
    units = {result["unit"] for result in report["results"]}
    assert units == {"ns/point", "ms", "x", "%", "cm"}
    contenders = {result["contender"] for result in report["results"]}
    assert all("rmw_manycore" in contender for contender in contenders)
    assert {"rmw_manycore 1 worker", "rmw_manycore alone on 1 CPU"} <= contenders
    found = [result for result in report["results"] if result["question"].startswith("found from")]
    drive, streets = 4 * 6, 3 * 2 * 4  # contenders and distances of each
    assert len(found) == drive + streets
    home = {r["contender"]: r["mean"] for r in found if r["question"].startswith("found from 0.5")}
    assert home["rmw_manycore 4 m, 2 m"] == 100.0
    assert all(result["median"] > 0 for result in report["results"] if result not in found)


def test_the_report_is_written(tmp_path: Path) -> None:
    run_bench("rmw", "round-trip", "--only", "futex", "--output", str(tmp_path))
    assert {path.name for path in tmp_path.iterdir()} == {
        "report.json",
        "results.csv",
        "samples.csv",
    }


@pytest.mark.skipif(len(os.sched_getaffinity(0)) < 2, reason="one CPU is no pair")
def test_what_the_machines_clusters_are_worth_is_measured(tmp_path: Path) -> None:
    report = run_bench("machine", "-o", str(tmp_path), "--plot", *MACHINE)
    assert {result["question"] for result in report["results"]} == {
        "cache line, one way",
        "wake-up, one way",
        "copy of 1 MiB",
        "round trip 64 B",
    }
    assert (tmp_path / "matrix.svg").exists()
    rows = [line.split(",") for line in (tmp_path / "matrix.csv").read_text().splitlines()]
    assert rows[0][1:] == [row[0] for row in rows[1:]]
    for number, row in enumerate(rows[1:], start=1):
        assert row[number] == ""
        assert all(float(ns) > 0 for ns in row[1:number] + row[number + 1 :])


def test_a_plot_needs_a_place() -> None:
    command = manycore_command("bench", "rmw", "--quick", "--plot")
    result = subprocess.run([str(word) for word in command], text=True, capture_output=True)
    assert result.returncode == 2
    assert "--output" in result.stderr


@pytest.mark.stress
def test_bridge() -> None:
    report = run_bench("bridge", *BRIDGE)
    assert {result["contender"] for result in report["results"]} >= {"bridged", FAST_DDS_AND_OURS}


@pytest.mark.skipif(not can_have_hosts(), reason="network namespaces need root")
def test_images_that_reach_another_host_are_counted() -> None:
    rows = run_bench("bridge", "--only", "another host, reliable, free CPUs")["results"]
    assert {row["contender"] for row in rows} == {"bridged", "Fast DDS as installed"}
    assert all(0 < row["median"] <= 100 for row in rows)


@pytest.mark.stress
def test_the_reference_system_is_measured_and_loses_nothing_where_all_is_kept() -> None:
    parts = only("checked: manycore", "untouched, cycles 0: manycore")
    rows = {row["question"]: row for row in run_bench("reference", *parts)["results"]}
    assert rows["memory per node, PSS, checked"]["samples"] == 24
    for figure in ("CPU of all nodes", "start to the first output", "hot path"):
        assert rows[f"{figure}, checked"]["median"] > 0
    assert rows["lost messages, untouched, cycles 0"]["largest"] == 0
    assert rows["messages through the hot path, untouched, cycles 0"]["median"] > 0


@pytest.mark.stress
def test_the_same_rclpy_nodes_of_the_reference_system_run_on_each_middleware() -> None:
    parts = ("--nodes", "rclpy", *only("untouched: manycore", "untouched: Fast DDS as installed"))
    rows = run_bench("reference", *parts)["results"]
    medians = {r["contender"]: r["median"] for r in rows if r["question"] == "hot path, untouched"}
    assert set(medians) == {"manycore", "Fast DDS as installed"}
    assert all(median > 0 for median in medians.values())


TRANSFERS = ("noc", "--size", "100", "--size", "2000", "--size", "10000")
PRODUCTS = ("matrix", "--n", "32", "--n", "48")
BOSTAN = ("--model", "bostan")


@pytest.mark.parametrize("model", [(), BOSTAN], ids=["host", "model"])
def test_transfers_lose_nothing_with_flow_control(model: tuple[str, ...], tmp_path: Path) -> None:
    report = run_bench(*TRANSFERS, *model, "--output", str(tmp_path), "--plot")
    names = {relation["name"] for relation in report["relations"]}
    assert {f"T{number}" for number in range(1, 8)} - names <= {"T2"}  # of a machine with one CPU
    bases = {relation["basis"] for relation in report["relations"]}
    assert bases == ({"derived", "fitted"} if model else {"measured"})
    lost = {r["contender"]: r["largest"] for r in report["results"] if "lost" in r["question"]}
    assert lost["with credits"] == 0
    if model:  # on the host the reader may keep up
        assert lost["without flow control"] > 0
    figures = [f"figure_{name}.svg" for name in ("4_2", "4_3", "4_4", "4_5", "4_6_and_4_7")]
    assert sorted(path.name for path in tmp_path.glob("figure_*")) == figures
    assert "UC from CC SMEM, cluster to cluster" in (tmp_path / "samples.csv").read_text()


@pytest.mark.parametrize("model", [(), BOSTAN], ids=["host", "model"])
def test_products_have_the_same_bits_for_every_split(model: tuple[str, ...]) -> None:
    report = run_bench(*PRODUCTS, *model)
    names = {relation["name"] for relation in report["relations"]}
    assert {"M1", "M2", "M2b", "M2c", "M3b", "M4", "M5"} <= names
    assert model or all_reached(report)
