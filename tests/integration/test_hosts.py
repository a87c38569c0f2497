# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One mapfile over two hosts, here two platforms of one machine."""

from __future__ import annotations

import signal
from collections.abc import Iterator

import pytest

from support import IS_MANYCORE, wait_until
from support.nodes.parted import HEARD, HOSTS, Parted
from support.nodes.serving import call, count, send_goal, serve
from support.nodes.speakers import hear, say
from support.nodes.zenoh_peers import free_port, locator
from support.processes.commands import manycore_command
from support.processes.platforms import leftovers

pytestmark = [
    pytest.mark.integration,
    pytest.mark.needs("zenoh", "xxhash"),
    pytest.mark.skipif(not IS_MANYCORE, reason="hosts are part of rmw_manycore"),
]

LATCHED = {"durability": "transient_local", "depth": 2}


@pytest.fixture
def platforms() -> Iterator[list[str]]:
    """Names of platforms that leave nothing, once `start` has ended their programs."""
    names: list[str] = []
    yield names
    for name in names:
        wait_until(lambda name=name: not leftovers(name), f"{name} leaves nothing in /dev/shm")


@pytest.fixture
def hosts(platforms, start, tmp_path) -> Parted:
    made = Parted(start, tmp_path, {host: locator(free_port()) for host in HOSTS})
    platforms += made.platforms.values()
    return made


def test_topics_between_hosts(hosts) -> None:
    runs = hosts.run_both()
    assert "talker" not in runs["b"].output
    assert hosts.row("a", "outward", "/chatter")["lost"] == 0
    assert hosts.row("b", "inward", "/chatter")["lost"] == 0
    for run in runs.values():
        assert run.stop() == 0


def test_what_no_host_takes_does_not_cross(hosts) -> None:
    hosts.run_both()
    hosts.node("a", say, "/untaken", {}, 0.02).wait_for("^said$")
    wait_until(lambda: hosts.row("b", "inward", "/untaken"), "the other host knows of it")
    row = hosts.row("a", "outward", "/untaken")
    assert (row["messages"], row["state"]) == (0, "ready")
    hosts.node("b", hear, "/untaken", {}).wait_for("^heard again")


def test_a_late_subscriber_gets_what_was_latched_on_another_host(hosts) -> None:
    hosts.run_both()
    hosts.node("a", say, "/map", LATCHED, None, "older", "old", "new").wait_for("^said$")
    late = hosts.node("b", hear, "/map", LATCHED)
    late.wait_for("^heard old")
    late.wait_for("^heard new")


def test_services_and_actions_between_hosts(hosts) -> None:
    hosts.run_both()
    hosts.node("b", serve, True)
    caller = hosts.node("a", call, 2)
    for expected in ("True", "False"):
        caller.wait_for(f"^answer {expected} served$")
    counter, sender = hosts.node("a", count), hosts.node("b", send_goal)
    sender.wait_for(r"^feedback \[0, 1\]$")
    counter.signal(signal.SIGUSR1)
    sender.wait_for(r"^status 4 \[0, 1, 1\]$")  # succeeded
    assert hosts.row("a", "outward", "/lamp", "service")["messages"] == 2


def test_a_host_that_goes_away_and_comes_back(hosts) -> None:
    runs = hosts.run_both()
    runs["a"].kill()
    runs["b"].wait_for(r"hosts inward.* lost /manycore_host_a_outward; connecting again")
    wait_until(lambda: hosts.row("b", "inward", "/chatter")["state"] == "waiting", "it is gone")
    runs["b"].skip_output()
    hosts.run("a")
    runs["b"].wait_for(HEARD)


def test_a_host_that_the_mapfile_lacks(hosts, start) -> None:
    run = start(manycore_command("run", hosts.mapfile, "--host", "c"))
    run.wait_for("--host: no host 'c' in .*; it has a, b")
