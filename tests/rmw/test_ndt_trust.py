# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What `ndt_scan_matcher` believes, how it recovers, and its state after a kill."""

from __future__ import annotations

import os
import signal
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import PoseWithCovarianceStamped

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.nodes.scan_matcher.real_time import schedule_in_real_time
from rmw_manycore_py.ndt.simulation.drive import poses_along
from support import TIMEOUT_S, wait_until
from support.nodes.ros import spin_until
from support.nodes.scan_matching import (
    TRUTH,
    error_m,
    matcher_command,
    street_map,
    street_scan,
    two_host_cpus,
    workers_below,
)

FAR = poses_along([14.0])[0]  # farther than an alignment from TRUTH converges
# From here all looks at a scan of TRUTH end elsewhere but the second one.
FAR_GUESS = TRUTH @ poses.from_xyz_rpy((7.0, 0.0, 0.0), (0.0, 0.0, 0.3))
FARTHER = TRUTH @ poses.from_xyz_rpy((17.0, 0.0, 0.0), (0.0, 0.0, 0.3))
SEARCHING = "searching globally"
PRIORITY = 5


def values_of(report: Any) -> dict[str, str]:
    return {pair.key: pair.value for pair in report.values}


def answered(stack: Any, scan: np.ndarray, guess: np.ndarray) -> tuple[list[Any], np.ndarray]:
    """Publish a scan until it gets a pose; return all reports and the pose."""
    reports: list[Any] = []
    deadline = time.monotonic() + TIMEOUT_S
    while not reports or values_of(reports[-1])["skipping_publish_num"] != "0":
        assert time.monotonic() < deadline, f"no pose: {reports[-1]}"
        reports.append(stack.report_of(stamp_ns := stack.send(scan, guess)))
    spin_until(stack.node, lambda: stamp_ns in stack.poses)
    return reports, stack.poses[stamp_ns]


def test_a_first_pose_is_unsure_and_later_ones_are_not(matched):
    heard: list[Any] = []
    matched.node.create_subscription(
        PoseWithCovarianceStamped, "ndt_pose_with_covariance", heard.append, 10
    )
    matched.pose_of(street_scan())
    spin_until(matched.node, lambda: heard)
    assert heard[0].pose.covariance[0] >= 1.0
    matched.be_sure()
    matched.pose_of(street_scan())
    spin_until(matched.node, lambda: heard[-1].pose.covariance[0] < 0.1)


def test_a_first_guess_from_far_off_gets_a_second_look_where_nothing_searches(stack, start):
    start(matcher_command(recovery__after_scans=0), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    reports, T = answered(stack, street_scan(), FAR_GUESS)
    assert values_of(reports[-1])["second_looks"] == "1"
    assert error_m(T) < 0.1
    stack.pose_of(street_scan())
    report = stack.report_of(stack.send(street_scan()))
    assert values_of(report)["second_looks"] == "1"  # one that converges well has none


@pytest.mark.parametrize(("guess", "step"), [(FAR_GUESS, "tracking"), (FARTHER, SEARCHING)])
def test_a_first_pose_is_one_of_the_places_around_or_left_to_a_search(matched, guess, step):
    reports, T = answered(matched, street_scan(), guess)
    judged = [values for report in reports if "second_looks" in (values := values_of(report))]
    assert {values["second_looks"] for values in judged} == {"0"}  # without the map it has none
    assert judged[0]["recovery_step"] == step  # with the first scan
    assert error_m(T) < 0.1


def test_guesses_that_jump_do_not_lead_the_poses_astray(matched):
    matched.be_sure()
    for guess in (FAR, FAR, poses.from_xyz_rpy((1e5, 0.0, 0.0))):
        stamp_ns = matched.send(street_scan(), guess)
        report = matched.report_of(stamp_ns)
        spin_until(matched.node, lambda stamp_ns=stamp_ns: stamp_ns in matched.poses)
        assert error_m(matched.poses[stamp_ns]) < 0.1, report.message


def test_a_vehicle_that_was_carried_away_is_found_while_scans_go_on(matched):
    matched.be_sure()
    scan = street_scan(FAR)
    reports, T = answered(matched, scan, TRUTH)
    searching = ["searching" in values_of(report)["recovery_step"] for report in reports]
    assert sum(searching) > 2  # they were judged while the search ran
    assert poses.distance_m(T, FAR) < 0.1


def test_as_in_autoware_nothing_is_searched(stack, start):
    start(matcher_command(behaviour="autoware"), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    stack.pose_of(street_scan())
    report = stack.report_of(stack.send(street_scan(FAR)))
    ours = {"recovery_step", "score_level", "is_sure", "second_looks"}
    assert not ours & set(values_of(report))


def test_a_matcher_that_was_killed_goes_on_where_it_was(stack, start, tmp_path: Path):
    """It is activated as before, and recovers although its guesses stay behind."""
    parameters = {"activated": "false", "last_pose_path": tmp_path / "pose"}
    first = start(matcher_command(**{**parameters, "activated": "true"}), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    stack.pose_of(street_scan())
    os.kill(first.pid, signal.SIGKILL)
    first.wait()
    stack.poses.clear()
    start(matcher_command(**parameters), cluster=2)
    stack.wait_for_matcher()
    stack.publish_map(street_map())
    assert error_m(answered(stack, street_scan(), FAR)[1]) < 0.1


def test_real_time_where_it_is_allowed(stack, start):
    if not is_allowed():
        pytest.skip("real-time scheduling is not allowed here")
    cpus = two_host_cpus()
    program = start(
        matcher_command(worker_host_cpus=str(cpus), realtime_priority=PRIORITY), cluster=2
    )
    stack.wait_for_matcher()
    workers = workers_below(program.pid)
    assert len(workers) == 2
    wait_until(lambda: all(map(is_in_real_time, workers)), "workers are in real time")

    def are_threads() -> bool:  # executor thread and matching thread
        tasks = Path(f"/proc/{program.pid}/task").iterdir()
        return sum(is_in_real_time(int(task.name)) for task in tasks) >= 2

    wait_until(are_threads, "threads are in real time")
    stack.publish_map(street_map())
    assert error_m(stack.pose_of(street_scan())) < 0.1
    stack.publish_map(street_map())  # the first map was built in the node's process
    spin_until(stack.node, lambda: stack.send(street_scan()) and helpers_below(program.pid))
    wait_until(
        lambda: not any(map(is_in_real_time, helpers_below(program.pid))), "it has left real time"
    )


def test_real_time_that_limits_forbid_is_refused():
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        words = "allowed"
        try:
            if os.getuid() == 0:
                os.setuid(65534)
            schedule_in_real_time(PRIORITY, [])
        except ManycoreError as error:
            words = str(error)
        finally:
            os.write(writer, words.encode())
            os._exit(0)
    os.close(writer)
    words = os.read(reader, 10_000).decode()
    os.close(reader)
    os.waitpid(child, 0)
    if words == "allowed":
        pytest.skip("every user may use real-time scheduling here")
    assert "realtime_priority: expected at most" in words
    assert "ulimit -r" in words


def is_in_real_time(pid: int) -> bool:
    with suppress(ProcessLookupError):  # it has ended
        is_fifo = os.sched_getscheduler(pid) == os.SCHED_FIFO
        return is_fifo and os.sched_getparam(pid).sched_priority == PRIORITY
    return False


def is_allowed() -> bool:
    child = os.fork()
    if child == 0:
        try:
            schedule_in_real_time(PRIORITY, [])
        except ManycoreError:
            os._exit(1)
        os._exit(0)
    return os.waitpid(child, 0)[1] == 0


def helpers_below(pid: int) -> list[int]:
    found = []
    for children in Path(f"/proc/{pid}/task").glob("*/children"):
        for child in map(int, children.read_text().split()):
            with suppress(FileNotFoundError, ProcessLookupError):  # it has ended
                if "helper_process" in Path(f"/proc/{child}/cmdline").read_text():
                    found.append(child)
    return found
