# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Programs of the Python API, and threads and processes of their own, in virtual time."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from support import IS_MANYCORE
from support.nodes import timed_programs
from support.peers.programs import forked_manycore

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

NS_PER_S = 10**9


@pytest.fixture
def run(timed_mapfile, log_of):
    """Return a function that runs programs in virtual time; it returns what each printed."""

    def run(*names: str, options: tuple[str, ...] = ("--instant",)) -> dict[str, list[str]]:
        return log_of(timed_mapfile(timed_programs, *names), 2, *options)

    return run


def test_computing_takes_time_before_a_publish_and_before_a_wait(run) -> None:
    published_ns, waited_ns = map(int, run("computing", options=("--factor", "2"))["computing"])
    assert published_ns >= 10_000_000
    assert waited_ns >= 20_000_000


def test_a_thread_that_has_waited_for_nothing_sees_virtual_time(run) -> None:
    half_s = str(NS_PER_S // 2)
    assert run("threads")["threads"] == [half_s, half_s]


def test_a_thread_that_is_ending_lives_in_wall_time(run) -> None:
    assert run("leaver")["leaver"] == [f"{NS_PER_S // 2} True"]


def test_time_stands_while_maps_are_built_in_the_background(run) -> None:
    assert run("builder")["builder"] == ["100 0.0 ", "100 0.0 "]


def test_durations_that_nodes_report_are_virtual(run) -> None:
    assert run("stages")["stages"] == ["0.0"]


def test_a_pass_of_a_thread_with_a_seat_is_late_in_virtual_time(run) -> None:
    (late_s,) = run("passes", options=("--factor", "1"))["passes"]
    assert 1.0 <= float(late_s) < 1.5


def test_the_path_of_the_environment_has_spaces(start, timed_mapfile, tmp_path: Path) -> None:
    environment = tmp_path / "my env: 1"
    (environment / "bin").mkdir(parents=True)
    python = environment / "bin" / "python3"
    python.symlink_to(Path(sys.executable).resolve())
    for name in ("lib", "share", "pyvenv.cfg"):
        (environment / name).symlink_to(Path(sys.prefix) / name)
    main = "from rmw_manycore_py.cli.main import main; main()"
    file = timed_mapfile(timed_programs, "threads")
    options = ("--virtual", "--instant", "--duration", "2")
    run = start([python, "-c", main, "run", file, *options])
    assert run.wait() == 0
    assert run.lines.count(f"threads  | {NS_PER_S // 2}") == 2


def test_too_many_threads_are_named(start, timed_mapfile) -> None:
    file = timed_mapfile(timed_programs, "crowd")
    crowded = start(forked_manycore("run", file, "--virtual", "--instant"))
    crowded.wait_for("crowd has one thread too many: 2048 may wait at a time")
    assert crowded.wait() == 1


def test_processes_of_a_program_go_on_in_the_order_in_which_they_joined(run) -> None:
    log = run("early", "family", "ear")
    assert log["ear"] == [f"{at_ms} {number}" for at_ms in (300, 400, 500) for number in (1, 2)]
