# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Workers find the poses that a single core finds, also when some are killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt import Matcher, MatcherOptions, SerialMatcher, VoxelMap, WorkerMatcher
from rmw_manycore_py.ndt.trust.search import Region, search
from support import wait_until
from support.nodes.scan_matching import killed_as_they_come
from support.processes.inspection import is_asleep, kill
from support.samples.ndt_world import pose, scan_at, street

pytestmark = pytest.mark.integration

WORLD = street()
TRUE = pose(40, 0.5, 1.8, 0.01, -0.02, 0.3)
GUESS = pose(40.4, 0.2, 1.9, 0, 0, 0.34)
FAR = TRUE @ pose(6, 3, 0, 0, 0, 0.3)  # is looked at again
SCAN = scan_at(WORLD, TRUE)
DENSE = np.concatenate([SCAN, SCAN])  # so large that few of its points approach the pose
OPTIONS = MatcherOptions()
MAP = VoxelMap.from_points(WORLD, OPTIONS)
CPUS = sorted(os.sched_getaffinity(0))


def workers(count: int) -> WorkerMatcher:
    matcher = WorkerMatcher(OPTIONS, [CPUS[i % len(CPUS)] for i in range(count)])
    matcher.set_map(MAP)
    return matcher


def alone() -> SerialMatcher:
    matcher = SerialMatcher(OPTIONS)
    matcher.set_map(MAP)
    return matcher


def numbers(alignment: Any) -> tuple[Any, ...]:
    return (
        alignment.T_map_sensor.tolist(),
        alignment.covariance.tolist(),
        alignment.iterations,
        alignment.looks,
        alignment.score,
        alignment.nearest_voxel_likelihood,
    )


def has_ended(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")")[-1].split()[0] in "ZX"
    except (FileNotFoundError, ProcessLookupError):
        return True


def cpu_ns(pid: int) -> int:
    tasks = Path(f"/proc/{pid}/task").glob("*/schedstat")
    return sum(int(task.read_text().split()[0]) for task in tasks)


@pytest.mark.parametrize("count", [1, 2, 3, 7, 16])
def test_any_number_of_workers_finds_the_same_pose_bit_for_bit(count: int) -> None:
    with workers(count) as matcher:
        for guess in (GUESS, TRUE, pose(40.9, 0, 1.8, 0, 0, 0.25), FAR):
            for scan in (SCAN, DENSE):
                assert numbers(matcher.align(scan, guess)) == numbers(alone().align(scan, guess))
        assert matcher.score(SCAN, GUESS) == alone().score(SCAN, GUESS)


def places(matcher: Matcher) -> list[tuple[Any, ...]]:
    """Return where a search of the whole map finds the scan, best first."""
    region = Region(pose(0, 0, 0, 0.01, -0.02, 0), np.inf, any_yaw=True)
    return [numbers(place) for place in search(matcher, SCAN, region).places]


@pytest.mark.parametrize("count", [1, 2, 5])
def test_any_number_of_workers_finds_the_same_places(count: int) -> None:
    with workers(count) as matcher:
        found = places(matcher)
    assert found == places(alone())
    assert np.linalg.norm(np.array(found[0][0])[:2, 3] - TRUE[:2, 3]) < 0.1


def test_workers_killed_in_the_middle_of_searches_are_replaced_and_miss_nothing() -> None:
    expected = places(alone())
    rng = np.random.default_rng(2)
    with workers(3) as matcher:
        for i in range(8):
            victim = matcher.worker_pids[i % 3]
            killer = threading.Timer(rng.uniform(0, 0.1), kill, (victim,))
            killer.start()
            assert places(matcher) == expected
            killer.join()
        matcher.score(SCAN, GUESS)
        assert matcher.replaced_workers >= 8


def test_each_worker_is_a_process_on_its_cpu() -> None:
    with workers(2) as matcher:
        pids = matcher.worker_pids
        assert len(set(pids)) == 2
        for pid, cpu in zip(pids, [CPUS[0], CPUS[1 % len(CPUS)]], strict=True):
            assert os.sched_getaffinity(pid) == {cpu}
    wait_until(lambda: all(has_ended(pid) for pid in pids), "the workers end with the matcher")


def test_passes_of_each_worker_lie_in_the_alignment() -> None:
    with workers(3) as matcher:
        begin_ns = time.monotonic_ns()
        matcher.align(SCAN, GUESS, only_pose=True)
        end_ns = time.monotonic_ns()
        found = matcher.passes()
    by_worker = [[row[1:] for row in found if row[0] == worker] for worker in range(3)]
    assert len({len(rows) for rows in by_worker}) == 1
    for rows in by_worker:
        assert [number for number, _, _ in rows] == list(range(len(rows)))
        times = [time_ns for _, *span in rows for time_ns in span]
        assert [begin_ns, *times, end_ns] == sorted([begin_ns, *times, end_ns])


@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGTERM])
def test_a_worker_killed_between_alignments_is_replaced(end: signal.Signals) -> None:
    expected = numbers(alone().align(SCAN, GUESS))
    with workers(3) as matcher:
        victim = matcher.worker_pids[1]
        os.kill(victim, end)
        wait_until(lambda: has_ended(victim), "the worker is gone")
        assert numbers(matcher.align(SCAN, GUESS)) == expected
        assert matcher.replaced_workers >= 1  # more where one got no CPU for seconds
        assert victim not in matcher.worker_pids


def test_workers_killed_in_the_middle_of_alignments_are_replaced() -> None:
    expected = numbers(alone().align(SCAN, GUESS))
    rng = np.random.default_rng(1)
    with workers(3) as matcher:
        pids = matcher.worker_pids
        for i in range(60):
            delay_s = rng.uniform(0, 4e-3)  # an alignment takes that long
            killer = threading.Timer(delay_s, kill, (pids[i % 3],))
            killer.start()
            assert numbers(matcher.align(SCAN, GUESS)) == expected
            killer.join()
            assert numbers(matcher.align(SCAN, GUESS)) == expected
            pids = matcher.worker_pids
        assert matcher.replaced_workers >= 60


def test_a_stopped_worker_is_replaced() -> None:
    expected = numbers(alone().align(SCAN, GUESS))
    with workers(2) as matcher:
        os.kill(matcher.worker_pids[1], signal.SIGSTOP)
        assert numbers(matcher.align(SCAN, GUESS)) == expected
        assert matcher.replaced_workers >= 1  # more where one got no CPU for as long


def test_workers_that_die_again_and_again() -> None:
    """The error states it; the previous map stays, and the matcher goes on."""
    moved = VoxelMap.from_points(WORLD + np.array([0, 50, 0]), OPTIONS)
    maps = cycle((moved, MAP))
    serial = alone()
    with workers(2) as matcher:

        def swap() -> None:
            following = next(maps)
            matcher.set_map(following)
            serial.set_map(following)

        for attempt in (
            lambda: matcher.align(SCAN, GUESS),
            lambda: matcher.score(SCAN, GUESS),
            swap,
        ):
            with killed_as_they_come(os.getpid()), pytest.raises(ManycoreError, match="5 times"):
                until_it_fails(attempt)
            assert numbers(matcher.align(SCAN, GUESS)) == numbers(serial.align(SCAN, GUESS))


def until_it_fails(attempt: Callable[[], object]) -> None:
    """Repeat the attempt until it raises; a kill may come too late for one attempt."""
    while True:
        attempt()


def test_workers_sleep_between_alignments() -> None:
    with workers(2) as matcher:
        matcher.align(SCAN, GUESS)
        pids = matcher.worker_pids
        wait_until(lambda: all(map(is_asleep, pids)), "the workers have gone to sleep")
        before = [cpu_ns(pid) for pid in pids]
        assert not threading.Event().wait(1.0)  # a second in which nothing is due
        assert [cpu_ns(pid) for pid in pids] == before


def test_workers_end_when_their_coordinator_is_killed() -> None:
    program = (
        "import time; from rmw_manycore_py.ndt import WorkerMatcher; "
        f"m = WorkerMatcher(None, [{CPUS[0]}, {CPUS[0]}]); "
        "print(*m.worker_pids, flush=True); time.sleep(600)"
    )
    process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    pids = [int(word) for word in process.stdout.readline().split()]
    assert len(pids) == 2
    assert not any(has_ended(pid) for pid in pids)
    process.kill()
    process.communicate()
    wait_until(lambda: all(has_ended(pid) for pid in pids), "the workers end with their parent")


def test_the_map_is_swapped_between_alignments() -> None:
    moved = VoxelMap.from_points(WORLD + np.array([0, 5, 0]), OPTIONS)
    beside = GUESS.copy()
    beside[1, 3] += 5
    with workers(2) as matcher:
        first = matcher.align(SCAN, GUESS)
        matcher.set_map(moved)
        second = matcher.align(
            SCAN, GUESS + np.array([[0, 0, 0, 0], [0, 0, 0, 5.0], [0] * 4, [0] * 4])
        )
    assert second.T_map_sensor[1, 3] - first.T_map_sensor[1, 3] == pytest.approx(5, abs=0.02)


def test_two_million_points_are_aligned() -> None:
    huge = np.tile(SCAN, (2_000_000 // len(SCAN) + 1, 1))
    with workers(2) as matcher:
        found = matcher.align(huge, GUESS)
    assert found.converged
    assert found.T_map_sensor == pytest.approx(alone().align(SCAN, GUESS).T_map_sensor, abs=1e-3)


@pytest.mark.parametrize("scan", [np.zeros((0, 3)), np.full((9, 3), np.nan), SCAN[:1], SCAN[:5]])
def test_scans_of_nothing_leave_the_workers_well(scan: Any) -> None:
    with workers(2) as matcher:
        found = matcher.align(scan, GUESS)
        assert np.isfinite(found.T_map_sensor).all()
        assert matcher.align(SCAN, GUESS).converged


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: WorkerMatcher(OPTIONS, []), "host_cpus: expected 1 to 64"),
        (
            lambda: WorkerMatcher(OPTIONS, [4095]),
            "host CPU 4095 is not in this process's affinity mask",
        ),
    ],
)
def test_cores_that_are_not_there_are_refused(make: Callable[[], Any], message: str) -> None:
    with pytest.raises(ManycoreError, match=message):
        make()


def test_a_closed_matcher_raises() -> None:
    matcher = workers(1)
    matcher.close()
    matcher.close()
    with pytest.raises(ManycoreError, match="closed"):
        _ = matcher.worker_pids


def test_the_workers_program_is_found_from_a_library_near_the_root(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As of `pip install --target /deps`; its files are searched for in the prefix last."""
    monkeypatch.setattr(_ndt, "__file__", "/deps/native/_ndt.so")
    with WorkerMatcher(OPTIONS, CPUS[:1]) as matcher:
        assert len(matcher.worker_pids) == 1
