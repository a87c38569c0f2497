# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs in virtual time are repeatable, whatever else the host does."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from functools import partial
from pathlib import Path

import pytest

from support import IS_MANYCORE
from support.nodes import timed
from support.peers.programs import forked_manycore
from support.samples.recordings import write_texts

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

START_NS = 10**18
NS_PER_S = 10**9


@pytest.fixture
def mapfile(timed_mapfile):
    """Return a function that writes a mapfile of kinds of timed nodes."""
    return partial(timed_mapfile, timed)


@contextmanager
def busy_loops() -> Iterator[None]:
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(3)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


@contextmanager
def one_cpu() -> Iterator[None]:
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(before)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def test_the_same_run_again_beside_load_and_on_one_cpu(mapfile, log_of) -> None:
    file = mapfile("talker", "echo", "asker", "server")
    logs = []
    for condition in (nullcontext, busy_loops, one_cpu):
        with condition():
            logs.append(log_of(file, 2))
    assert set(logs[0]) == {"talker", "echo", "asker"}
    assert logs[1:] == [logs[0], logs[0]]
    # A message is there, and answered, at the time at which it was published.
    assert logs[0]["talker"] == [
        f"heard talker {n} {at_ns} {at_ns}"
        for n in range(1, 20)
        for at_ns in [START_NS + n * NS_PER_S // 10]
    ]
    at_ns = START_NS + 7 * NS_PER_S // 100
    assert logs[0]["echo"][0] == f"echo 1 {at_ns} {at_ns}"
    # The server comes up at 0.3 s, which is seen at 0.5 s, and takes 20 ms for an answer.
    at_ns = START_NS + NS_PER_S // 2
    assert logs[0]["asker"][0] == f"server {at_ns} {at_ns}"
    assert logs[0]["asker"][2] == (
        f"answer server 2 {at_ns + 4 * NS_PER_S // 100} {at_ns + 4 * NS_PER_S // 100}"
    )


@pytest.mark.parametrize("duration", ["1e9", "inf"])
def test_time_may_have_no_end(mapfile, start, duration) -> None:
    words = ("--virtual", "--instant", "--duration", duration)
    run = start(forked_manycore("run", mapfile("talker", "echo"), *words))
    run.wait_for("heard talker 30 ")
    assert run.stop() == 0, run


def test_threads_of_an_executor_hold_time_while_they_compute(mapfile, log_of) -> None:
    log = log_of(mapfile("threads", "server"), 2.1)
    assert log["threads"] == [
        f"server {n} {at_ns} {at_ns}"
        for n in range(1, timed.N_CALLS + 1)
        for at_ns in [START_NS + (50 + 25 * n + 2) * NS_PER_S // 100]
    ]


def test_callbacks_on_threads_of_an_executor_take_time(mapfile, log_of) -> None:
    log = log_of(mapfile("threads", "server"), 20, "--factor", "1")  # starting takes time, too
    assert len(log["threads"]) == timed.N_CALLS


def test_a_node_is_killed_and_starts_again_at_the_same_times(mapfile, log_of) -> None:
    file = mapfile("talker", "mortal", rules=", respawn: {delay: 0.25}")
    logs = [log_of(file, 3.5) for _ in range(2)]
    assert logs[0] == logs[1]
    births = [line for line in logs[0]["mortal"] if line.startswith("born")]
    times_ns = [START_NS + n * 5 * NS_PER_S // 4 for n in range(3)]
    assert births == [f"born {time_ns} {time_ns}" for time_ns in times_ns]
    heard = [int(line.split()[2]) for line in logs[0]["mortal"] if line not in births]
    assert heard[7:11] == [8, 9, 13, 14]  # time went on meanwhile


def test_a_node_is_killed_from_outside_at_a_time(mapfile, log_of, manycore) -> None:
    env = f"{{{timed.BIRTHS}: /dev/null}}"
    file = mapfile("talker", "victim", rules=f", respawn: {{delay: 0}}, env: {env}")
    log = log_of(file, 2, "--virtual", "--instant", "--kill", "/victim@1.25")
    births = [line.split()[1] for line in log["victim"] if line.startswith("born")]
    assert births == [f"{START_NS}", f"{START_NS + 5 * NS_PER_S // 4}"]
    text = manycore("run", file, "--virtual", "--kill", "victm@1", status=2)
    assert f"--kill: no node 'victm' in {file}; did you mean 'victim'?" in text
    assert "started" not in text


def test_a_node_is_killed_in_the_virtual_time_of_the_mapfile(mapfile, manycore) -> None:
    file = mapfile("talker", "echo")
    words = ("run", file, "--duration", "2", "--kill", "echo@1")
    assert "--kill needs virtual time" in manycore(*words, status=2)
    file.write_text(f"clock: virtual\n{file.read_text()}")
    assert "manycore | echo finished: killed as asked" in manycore(*words)


def test_a_node_that_was_to_be_killed_has_not_failed(mapfile, log_of) -> None:
    file = mapfile("echo", "victim", rules=f", env: {{{timed.BIRTHS}: /dev/null}}")
    log = log_of(file, 2, "--instant", "--kill", "victim@0.7")
    assert len(log["victim"]) == 3  # born, and at 0.3 and 0.6 s
    assert len(log["echo"]) == 28  # every 0.07 s


def test_a_node_dies_and_starts_again_while_another_one_computes(
    mapfile, log_of, tmp_path: Path
) -> None:
    rules = f", respawn: {{delay: 0}}, env: {{{timed.BIRTHS}: {tmp_path}/births}}"
    log = log_of(mapfile("killer", "victim", rules=rules), 1.8)
    births = [line.split()[1] for line in log["victim"] if line.startswith("born")]
    assert births == [f"{START_NS}", f"{START_NS + NS_PER_S}"]
    times = [int(line.split()[2]) - START_NS for line in log["victim"] if "victim" in line]
    assert times == [n * NS_PER_S // 10 for n in (3, 6, 9, 13, 16)]


def test_a_shell_starts_a_node_again_and_again(mapfile, log_of) -> None:
    file = mapfile("talker", "mortal")
    start = f"[{sys.executable}, {timed.__file__}, mortal]"
    command = start[1:-1].replace(",", "")
    text = file.read_text()
    assert start in text
    file.write_text(text.replace(start, f"[sh, -c, 'while :; do {command}; done']"))
    births = [line.split()[1] for line in log_of(file, 2.5)["mortal"] if line.startswith("born")]
    assert births == [f"{START_NS + n * NS_PER_S}" for n in range(3)]


def test_who_lives_in_virtual_time_and_who_does_not(mapfile, log_of) -> None:
    """A tool without ROS does; a child of fork() does not, nor any process when time is over."""
    log = log_of(mapfile("parent", "stayer", "tool"), 1.5)
    assert log["parent"] == ["child True"]
    assert log["stayer"] == ["slept True"]
    assert log["tool"] == [f"tool {START_NS + n * NS_PER_S // 4}" for n in range(1, 5)]


def test_a_shell_starts_a_node(mapfile, log_of) -> None:
    file = mapfile("talker", "echo")
    text = file.read_text()
    start = f"[{sys.executable}, {timed.__file__}, talker]"
    assert start in text
    file.write_text(text.replace(start, f"[sh, -c, '{start[1:-1].replace(',', '')}; exit 0']"))
    assert len(log_of(file, 1)["talker"]) == 9


def test_computing_takes_time(mapfile, log_of) -> None:
    log = log_of(mapfile("talker", "echo"), 2, "--factor", "3")
    heard = (line for line in log["talker"] if line.startswith("heard"))
    times_ns = [int(line.split()[-1]) for line in heard]
    assert times_ns == sorted(times_ns)
    assert all(time_ns % (NS_PER_S // 10) != 0 for time_ns in times_ns)


def test_the_bridge_is_closed_and_mistakes_are_refused(manycore) -> None:
    text = manycore("run", "talker_listener", "--virtual", "--duration", "2")
    assert "virtual time: the bridge, which lives in wall time, stays closed" in text
    assert "I heard: 'Hello World: 1'" in text
    text = manycore("run", "talker_listener", "--virtual", "--join", status=2)
    assert "--join: the platform that is running lives in wall time" in text
    text = manycore("run", "talker_listener", "--instant", "--factor", "2", status=2)
    assert "--instant and --factor exclude each other" in text


def test_the_parts_of_hosts_run_together(mapfile, log_of, manycore) -> None:
    file = mapfile("talker", "echo")
    hosts = (f"  h{n}: {{clusters: [{n}], address: tcp/127.0.0.1:{7440 + n}}}" for n in (1, 2))
    file.write_text("\n".join(("hosts:", *hosts, file.read_text())))
    assert len(log_of(file, 1)["talker"]) == 9
    text = manycore("run", file, "--virtual", "--host", "h1", status=2)
    assert "without it, all nodes run on this one" in text


@pytest.mark.needs("mcap")
def test_a_recording_is_played_at_its_times(mapfile, log_of, tmp_path: Path) -> None:
    texts = [("/news", number / 100, str(number)) for number in range(200)]
    bag = write_texts(tmp_path / "bag.mcap", texts)
    file = mapfile("ear", "talker")
    play = f"command: [sh, -c, {sys.prefix}/bin/manycore topic play {bag} --delay 1]"
    file.write_text(file.read_text() + f"  player: {{{play}, cluster: 1}}\n")
    heard = [line.split()[1:] for line in log_of(file, 4)["ear"]]
    first_ns = int(heard[0][1])
    after_us = [round((int(at_ns) - first_ns) / 1000) for _, at_ns, _ in heard]
    assert [text for text, *_ in heard] == [str(number) for number in range(200)]
    assert after_us == [10_000 * number for number in range(200)]


@pytest.mark.needs("mcap")
def test_a_recorder_as_a_node_is_refused(mapfile, tmp_path: Path, manycore) -> None:
    """It waits for signals, which virtual time does not see."""
    file = mapfile("talker")
    recorder = f"{sys.prefix}/bin/manycore topic record -a -o {tmp_path}/bag.mcap"
    node = f"  recorder: {{command: [sh, -c, {recorder}], cluster: 1, ends_run: true}}\n"
    file.write_text(file.read_text() + node)
    text = manycore("run", file, "--virtual", "--instant", "--duration", "2", status=1)
    assert "the recorder would hold virtual time: start it beside `manycore run`" in text
    assert not (tmp_path / "bag.mcap").exists()


@pytest.mark.needs("mcap")
def test_the_bench_plays_a_recording_without_losses(tmp_path: Path, manycore) -> None:
    texts = [("/news", number / 100, str(number)) for number in range(100)]
    bag = write_texts(tmp_path / "bag.mcap", texts)
    report = json.loads(
        manycore("bench", "virtual", bag, "--runs", "2", "--duration", "3", "--json")
    )
    counts = [(run["taken"], run["lost"]) for run in report["runs"]]
    assert counts == [(100, 0)] * 2
    assert report["runs"][0]["digest"] == report["runs"][1]["digest"]
