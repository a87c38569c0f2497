# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The bridge under supervision, its tools, and its neighbours."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
from contextlib import ExitStack, suppress
from pathlib import Path

import pytest

from rmw_manycore_bridge.status import status
from rmw_manycore_bridge.time_slice import SLICE_NS, time_slice_ns
from rmw_manycore_py.platform.topology import HostCpu, as_host_cpu
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import DIRECTIONS, arranged
from support import IS_MANYCORE, MAPFILES, TIMEOUT_S, wait_until
from support.nodes.bridging import OUTSIDE, Bridge
from support.nodes.speakers import say
from support.peers.programs import forked_example, forked_manycore
from support.processes.commands import manycore_command
from support.processes.domains import domain_of
from support.processes.inspection import has_receive_threads
from support.processes.platforms import environment, leftovers, unique_platform
from support.processes.preloaded import preloaded

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

TALKER_LISTENER = MAPFILES / "talker_listener.yaml"
HEARD = "I heard: 'Hello World"
# With these values ROS 2 creates no DDS participant.
NO_KEYS = {"ROS_SECURITY_ENABLE": "true", "ROS_SECURITY_STRATEGY": "Enforce"}


def started(run, node: str) -> int:
    """Return the pid of the next process that is started as `node`."""
    while True:
        event = json.loads(run.wait_for(r"^\{.*").group())
        if event["event"] == "started" and event["node"] == node:
            return int(event["pid"])


def test_a_killed_bridge_is_started_again(start, platform) -> None:
    run = start(forked_manycore("run", TALKER_LISTENER, "--json"))
    pid = started(run, "(bridge outward)")
    listener = start(forked_example("listener"), **OUTSIDE)
    listener.wait_for(HEARD)
    os.kill(pid, signal.SIGKILL)
    assert started(run, "(bridge outward)") != pid
    listener.skip_output()
    listener.wait_for(HEARD)
    assert run.stop() == 0
    events = [json.loads(line) for line in run.lines if line.startswith("{")]
    assert [e["reason"] for e in events if e["event"] == "restarting"] == [
        "killed by SIGKILL (Killed)"
    ]
    numbers = [
        int(e["line"].rstrip("'").rpartition(" ")[2])
        for e in events
        if e["event"] == "output" and e["node"] == "listener" and HEARD in e["line"]
    ]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))  # nothing was lost inside
    assert leftovers(platform) == []


def test_a_second_signal_ends_it(bridge) -> None:
    for _ in range(4):
        (process,) = bridge.run(bridge.route("outward", "/chatter")).values()
        wait_until(lambda: bridge.row("outward", "/chatter").get("alive"), "it counts")
        wait_until(lambda: has_receive_threads(bridge.platform), "receive threads clean up")
        process.signal(signal.SIGINT)
        process.signal(signal.SIGTERM)
        assert process.wait() in (0, -signal.SIGINT, -signal.SIGTERM), process


def test_it_leaves_though_dds_never_does(bridge, tmp_path) -> None:
    plan = Plan(bridge.platform, arranged([bridge.route("outward", "/chatter")], 1))
    process = bridge.run_unforked(plan, "outward", **preloaded("no_leaving", tmp_path))
    bridge.inside(say, "/chatter", {}, 0.1)
    wait_until(lambda: bridge.row("outward", "/chatter").get("state") == "ready", "it is up")
    process.signal(signal.SIGINT)
    process.wait_for("^rmw_destroy_node 0x")
    assert process.wait() == 0


def test_the_bridge_ends_with_the_nodes(start, tmp_path, platform) -> None:
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(
        "nodes:\n  short: {cluster: 1, command: [python3, -c, ''], ros_arguments: false,"
        " topic_to: {chatter: std_msgs/msg/String}}\n"
    )
    run = start(forked_manycore("run", mapfile))
    assert run.wait() == 0
    assert "manycore | stopping: all nodes have ended" in run.lines


def test_a_bridge_that_never_comes_up_ends_the_run(start, tmp_path) -> None:
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(
        "nodes:\n  endless: {cluster: 1, command: [sleep, '1000'], ros_arguments: false,"
        " topic_to: {chatter: std_msgs/msg/String}}\n"
    )
    run = start(manycore_command("run", mapfile), **NO_KEYS)
    assert run.wait(4 * TIMEOUT_S) == 1, run  # three interpreters import rclpy, one after the other
    assert "(bridge outward) ended 3 times before it had come up" in run.output
    end = run.output.rpartition("(bridge outward) failed: exit status 1\n")[2]
    assert "failed to initialize rcl" in end


@pytest.mark.parametrize("named", [True, False])
def test_it_runs_on_the_cpus_of_the_mapfile(start, tmp_path, platform, named) -> None:
    usable = os.sched_getaffinity(0)
    cpu = max(usable)
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(
        f"bridge: {{host_cpu: {cpu if named else 'none'}}}\n"
        "nodes:\n  endless: {cluster: 1, command: [sleep, '1000'], ros_arguments: false,"
        " topic_to: {chatter: std_msgs/msg/String}}\n"
    )
    run = start(forked_manycore("run", mapfile, "--json"))
    pid = started(run, "(bridge outward)")
    threads = {int(entry.name) for entry in Path(f"/proc/{pid}/task").iterdir()}
    cpus = {frozenset(os.sched_getaffinity(thread)) for thread in threads}
    assert cpus == {frozenset({cpu} if named else usable)}
    wait_until(lambda: status(platform), "the process counts")
    assert status(platform)[0]["host_cpu"] == (cpu if named else shown(usable))
    assert run.stop() == 0


def test_its_threads_have_a_short_time_slice(bridge) -> None:
    if time_slice_ns() == 0:
        pytest.skip("Linux before 6.12 has no slices that a thread can ask for")
    plan = Plan(bridge.platform, arranged([bridge.route("outward", "/chatter")], 1))
    process = bridge.run_unforked(plan, "outward")

    def slices_ns() -> list[int]:
        tasks = Path(f"/proc/{process.pid}/task").iterdir()
        return [time_slice_ns(int(task.name)) for task in tasks]

    # The counters are there before the threads are.
    wait_until(lambda: len(found := slices_ns()) > 2 and set(found) == {SLICE_NS}, "all have it")


def shown(cpus: set[int]) -> HostCpu:
    """Return how the status shows a process that is not pinned."""
    return as_host_cpu(() if len(cpus) == os.cpu_count() else tuple(sorted(cpus)))


def test_status_shows_the_routes(start, platform) -> None:
    run = start(forked_manycore("run", TALKER_LISTENER))
    start(forked_example("listener"), **OUTSIDE).wait_for(HEARD)

    def shown_status(*options: str) -> str:
        command = [str(word) for word in manycore_command("bridge", "status", *options)]
        return subprocess.run(
            command, env=environment(platform), text=True, capture_output=True, check=True
        ).stdout

    wait_until(lambda: len(json.loads(shown_status("--json"))) == 2, "both directions count")

    def is_measured() -> bool:  # a message is counted before its latency
        outward = json.loads(shown_status("--json"))[1]
        return 0 < (outward["latency_mean_ns"] or 0) <= outward["latency_max_ns"]

    wait_until(is_measured, "its latency is counted, too")
    inward, outward = json.loads(shown_status("--json"))
    assert (inward["direction"], outward["direction"]) == ("inward", "outward")
    assert (outward["inside"], outward["state"], outward["alive"]) == (
        "/chatter",
        "forwarding",
        True,
    )
    assert "/chatter  ->  /chatter" in shown_status()
    assert run.stop() == 0


def test_a_bridge_file_of_domain_bridge(start, tmp_path, platform) -> None:
    config = tmp_path / "bridge.yaml"
    domain = domain_of(platform)
    config.write_text(
        f"from_domain: {domain + 100}\nto_domain: {domain}\n"
        "topics:\n"
        "  chatter: {type: std_msgs/msg/String, reversed: true, remap: news}\n"
        "  unknown: {type: no_such_msgs/msg/String, reversed: true}\n"
    )
    command = manycore_command("bridge", config, "--inside", str(domain + 100))
    bridge = start(command)
    bridge.wait_for(r"\(bridge inward\) started")
    bridge.wait_for(r"\(bridge inward\) \| .*no_such_msgs")
    start(forked_example("talker"), **OUTSIDE)
    start(forked_example("listener", "--ros-args", "-r", "chatter:=news")).wait_for(HEARD)


def test_ports_in_use_are_passed_over(start, platform) -> None:
    """The ports that the first participants of the domain would take (DDSI-RTPS 9.6.2.3)."""
    first = 7400 + 250 * domain_of(platform) + 10
    with ExitStack() as stack:
        for port in range(first, first + 6):
            taken = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            with suppress(OSError):  # already in use
                taken.bind(("", port))
        start(forked_manycore("run", TALKER_LISTENER))
        start(forked_example("listener"), **OUTSIDE).wait_for(HEARD)


def test_a_loop_is_refused(start, tmp_path, platform) -> None:
    config = tmp_path / "bridge.yaml"
    config.write_text(
        "from_domain: 2\nto_domain: 2\ntopics: {chatter: {type: std_msgs/msg/String}}\n"
    )
    bridge = start(forked_manycore("bridge", config))
    assert bridge.wait() == 2
    assert "expected two different domains, found 2 on both sides" in bridge.output


def test_a_second_bridge_of_a_platform_is_refused(bridge) -> None:
    """Both would pass on each message, and take what the other one passes on for another's."""
    routes = bridge.route("inward", "/chat"), bridge.route("outward", "/chat")
    first = bridge.run(*routes)
    for way in DIRECTIONS:
        wait_until(lambda way=way: bridge.row(way, "/chat"), "it runs")
    for way, second in bridge.run(*routes).items():
        second.wait_for(f"^process {first[way].pid} bridges this platform already: stop it, or")
        assert second.wait() == 1
        assert bridge.row(way, "/chat")["pid"] == first[way].pid


def test_two_platforms_meet_outside_only(start, platform, bridge) -> None:
    other = unique_platform()
    domain = str(domain_of(platform))
    bridge.run(bridge.route("outward", "/chatter"))
    second = Bridge(
        lambda command, **env: start(
            command, **{"MANYCORE_PLATFORM": other, "ROS_DOMAIN_ID": domain, **env}
        ),
        other,
    )
    second.domain = bridge.domain
    second.run(second.route("inward", "/chatter"))
    start(forked_example("talker"))
    start(forked_example("listener"), MANYCORE_PLATFORM=other, ROS_DOMAIN_ID=domain).wait_for(HEARD)
    wait_until(lambda: second.row("inward", "/chatter")["messages"], "it came through two bridges")
    assert bridge.row("outward", "/chatter")["own"] == 0
