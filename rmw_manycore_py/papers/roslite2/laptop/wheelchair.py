# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Wheelchair on the laptop: real-time plant, and sensor drivers that publish."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import Imu
from whill_msgs.msg import ModelCr2State

from rmw_manycore_py.ndt.messages.conversions import stamp_of
from rmw_manycore_py.papers.roslite2.laptop import topics
from rmw_manycore_py.papers.roslite2.laptop.drive_log import Command
from rmw_manycore_py.papers.roslite2.laptop.plant import Plant
from rmw_manycore_py.papers.roslite2.laws.odometry import motors_of_speed
from rmw_manycore_py.process.steady import steady_s

STEP_S = 0.01  # period of the IMU
STEPS_PER_STATE, STEPS_PER_SCAN = 4, 10
GYRO_STDDEV_RAD_S, GYRO_BIAS_RAD_S = 0.003, 0.002
SENSORS = ("lidar", "imu", "wheels")

Look = Callable[[int, Plant], None]


class Wheelchair:
    """Subscribes to cmd_vel only.

    :param look: called with stamp [ns] and plant when a scan is due.
    :param heard: called with each received command.
    """

    def __init__(self, node: Node, plant: Plant, look: Look, heard: Callable[[Command], None]):
        self._plant = plant
        self._look = look
        self._heard = heard
        self.stopped: set[str] = set()  # stopped sensors, a subset of SENSORS
        self._steps = 0
        self._moved_s = steady_s()
        self._generator = np.random.default_rng(7)
        self._imu = node.create_publisher(Imu, topics.IMU, 10)
        self._state = node.create_publisher(ModelCr2State, topics.STATE, 10)
        node.create_subscription(Twist, topics.CMD_VEL, self._on_command, 10)
        node.create_timer(STEP_S, self._step)

    def _on_command(self, message: Any) -> None:
        command = Command(time.time(), message.linear.x, message.angular.z)
        self._plant.command(steady_s(), command.speed_m_s, command.yaw_rate_rad_s)
        self._heard(command)

    def _step(self) -> None:
        """Advance by the elapsed time, since timers may be late."""
        now_s = steady_s()
        self._plant.advance(now_s, now_s - self._moved_s)
        self._moved_s = now_s
        stamp_ns = time.time_ns()
        if "imu" not in self.stopped:
            self._imu.publish(self._imu_message(stamp_ns))
        if self._steps % STEPS_PER_STATE == 0 and "wheels" not in self.stopped:
            self._state.publish(self._state_message())
        if self._steps % STEPS_PER_SCAN == 0 and "lidar" not in self.stopped:
            self._look(stamp_ns, self._plant)
        self._steps += 1

    def _imu_message(self, stamp_ns: int) -> Any:
        message = Imu()
        message.header.stamp, message.header.frame_id = stamp_of(stamp_ns), "base_link"
        noise = self._generator.normal(0.0, GYRO_STDDEV_RAD_S)
        message.angular_velocity.z = self._plant.yaw_rate_rad_s + GYRO_BIAS_RAD_S + float(noise)
        variance = GYRO_STDDEV_RAD_S**2
        message.angular_velocity_covariance = np.diag([variance] * 3).ravel()
        message.linear_acceleration_covariance[0] = -1.0  # not measured
        message.orientation_covariance[0] = -1.0
        return message

    def _state_message(self) -> Any:
        plant = self._plant
        motors = motors_of_speed(plant.speed_m_s, plant.yaw_rate_rad_s, plant.options.tread_m)
        left_km_h, right_km_h = motors
        return ModelCr2State(
            left_motor_speed=left_km_h, right_motor_speed=right_km_h, battery_power=100, power_on=1
        )
