# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A drive from the initial pose to the end of the course."""

from __future__ import annotations

import os
import shlex
import signal
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import rclpy
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.papers.roslite2.course.directory import Course
from rmw_manycore_py.papers.roslite2.laptop import topics
from rmw_manycore_py.papers.roslite2.laptop.drive_log import DriveLog, Incident, Injected
from rmw_manycore_py.papers.roslite2.laptop.faults import STOP_S, Fault, Kind
from rmw_manycore_py.papers.roslite2.laptop.laptop import Laptop
from rmw_manycore_py.papers.roslite2.laptop.lidar_process import LidarProcess
from rmw_manycore_py.papers.roslite2.laptop.plant import Plant
from rmw_manycore_py.papers.roslite2.laptop.stack import Stack, pid_of
from rmw_manycore_py.process.cpu_time import tree_cpu_s
from rmw_manycore_py.process.spinning import spin_once

TURN_S = 0.1  # period of the supervising loop
CPU_NOTE_S = 1.0  # rarely, since this process's CPU time is measured, too
GIVE_UP_S = 60.0  # time standing before the end


@dataclass(frozen=True)
class DriveOptions:
    """Limits and faults of a drive, in seconds.

    :param duration_s: from the first motion; None drives to the end of the course.
    :param timeout_s: maximum time to the first motion.
    """

    course: Path
    duration_s: float | None = None
    timeout_s: float = 120.0
    faults: Sequence[Fault] = ()
    seed: int = 1


class Drive:
    """Wheelchair, operator and observer in one node, and the loop that spins it."""

    def __init__(self, course: Course, options: DriveOptions, log: DriveLog, stack: Stack | None):
        self._options, self._log, self._stack = options, log, stack
        self._node: Node = rclpy.create_node("whill_laptop")
        self._lidar = LidarProcess(options.course, options.seed)
        self._laptop = Laptop(self._node, course, log, self._look)
        self._due = sorted(options.faults, key=lambda fault: fault.after_s)
        self._cpu_noted_s = 0.0

    def run(self, report: Callable[[DriveLog], None]) -> None:
        """Drive; call `report` periodically.

        :raises ManycoreError: if the vehicle does not start, or stops for good.
        """
        self._lidar.wait_until_ready()
        self._spin_until(lambda: self._laptop.is_moving, self._options.timeout_s, report)
        if not self._laptop.is_moving:
            raise ManycoreError(self._reason_for_standing())
        start_s = time.monotonic()
        before_s, packets = self._cpu_s(), self._packets()
        duration_s = self._options.duration_s or float("inf")
        self._spin_until(lambda: self._is_over(start_s), duration_s, report)
        self._note_cpu(before_s, time.monotonic() - start_s)
        if packets is not None:
            self._log.packets_in = (self._packets() or packets) - packets

    def close(self) -> None:
        """Stop the LiDAR driver and destroy the node."""
        self._lidar.close()
        self._node.destroy_node()

    def _spin_until(
        self, done: Callable[[], bool], timeout_s: float, report: Callable[[DriveLog], None]
    ) -> None:
        start_s = turn_s = time.monotonic()
        while not done() and time.monotonic() - start_s < timeout_s:
            spin_once(self._node, TURN_S, (signal.SIGINT, signal.SIGTERM))
            if time.monotonic() >= turn_s:
                turn_s += TURN_S
                self._turn()
                report(self._log)

    def _turn(self) -> None:
        self._laptop.note()
        if self._stack is not None:
            self._stack.check()
            if time.monotonic() - self._cpu_noted_s >= CPU_NOTE_S:
                self._cpu_noted_s = time.monotonic()
                self._stack.note_cpu()
        start_s = self._log.start_s()
        while start_s is not None and self._due and time.time() - start_s >= self._due[0].after_s:
            self._inject(self._due.pop(0))

    def _look(self, stamp_ns: int, plant: Plant) -> None:
        self._lidar.look(stamp_ns, plant.x_m, plant.y_m, plant.yaw_rad)

    def _is_over(self, start_s: float) -> bool:
        """Return whether the vehicle has arrived; raise ManycoreError if it stands for good."""
        laptop = self._laptop
        has_arrived = laptop.has_arrived()
        if not has_arrived and min(laptop.stood_s, time.monotonic() - start_s) > GIVE_UP_S:
            raise ManycoreError(
                f"the vehicle stands, {laptop.left_m:.0f} m before the end of the course"
            )
        return has_arrived

    def _inject(self, fault: Fault) -> None:
        now_s = time.time()
        self._log.incidents.append(Incident(now_s, str(fault)))
        self._log.injected.append(Injected(now_s, fault.target, str(fault)))
        if fault.kind is Kind.SILENCE:
            self._laptop.wheelchair.stopped.add(fault.target)
            return
        pid = pid_of(self._stack, fault.target)
        if fault.kind is Kind.KILL:
            os.kill(pid, signal.SIGKILL)
            return
        os.kill(pid, signal.SIGSTOP)
        timer = threading.Timer(STOP_S, os.kill, (pid, signal.SIGCONT))
        timer.daemon = True
        timer.start()

    def _packets(self) -> int | None:
        return None if self._stack is None else self._stack.packets_received()

    def _cpu_s(self) -> tuple[float, float | None, float]:
        stack_s, bridge_s = (0.0, None) if self._stack is None else self._stack.cpu_s()
        laptop_s = time.process_time() + tree_cpu_s(self._lidar.pid)
        return stack_s, bridge_s, laptop_s

    def _note_cpu(self, before: tuple[float, float | None, float], wall_s: float) -> None:
        stack_s, bridge_s, laptop_s = self._cpu_s()
        if self._stack is not None:
            self._log.platform_cpu_percent = 100.0 * (stack_s - before[0]) / wall_s
        if bridge_s is not None and before[1] is not None:
            self._log.bridge_cpu_percent = 100.0 * (bridge_s - before[1]) / wall_s
        self._log.laptop_cpu_s = laptop_s - before[2]

    def _reason_for_standing(self) -> str:
        waited = f"the vehicle has not moved within {self._options.timeout_s:g} s"
        if not self._node.count_publishers(topics.CMD_VEL):
            mapfile = shlex.quote(f"{self._options.course}/whill.yaml")
            return (
                f"{waited}: nothing publishes {topics.CMD_VEL}; start the stack first, in the same "
                f"ROS_DOMAIN_ID: `manycore run {mapfile}`, or give --run"
            )
        if not self._laptop.operator.pointed:
            return (
                f"{waited}: {topics.INITIAL_POSE} has no subscription, so no initial pose was sent"
            )
        if not self._laptop.operator.sees_kinematics:
            return (
                f"{waited}: no {topics.KINEMATICS} after the initial pose; the log of "
                "pose_initializer_node and ndt_scan_matcher says why"
            )
        return (
            f"{waited}, but {topics.KINEMATICS} is published: see the warnings of the control nodes"
        )


def run(
    course: Course,
    options: DriveOptions,
    log: DriveLog,
    stack: Stack | None,
    report: Callable[[DriveLog], None],
) -> None:
    """Drive the course and fill the log. SIGTERM interrupts like Ctrl-C."""
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    # rclpy's own signal handlers would shut down the context while the node is spinning.
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    drive = Drive(course, options, log, stack)
    try:
        drive.run(report)
    finally:
        drive.close()
        rclpy.try_shutdown()
        signal.signal(signal.SIGTERM, before)
