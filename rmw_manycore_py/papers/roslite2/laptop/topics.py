# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Topics bridged between laptop and platform, as named in mapfiles/whill.yaml."""

from __future__ import annotations

# The only topic the wheelchair subscribes to.
CMD_VEL = "/whill/controller/cmd_vel"

STATE = "/whill/states/model_cr2"
IMU = "/sensing/imu/imu_data"
POINTS = "/sensing/lidar/points_downsampled"
INITIAL_POSE = "/initialpose"
ENGAGE = "/autoware/engage"
HEARTBEAT = "/external/heartbeat"
CLEAR_STOP = "/vehicle_cmd_gate/service/clear_external_emergency_stop"

# Subscribed by the observer, for measurement.
POSE = "/localization/pose_estimator/pose"
KINEMATICS = "/localization/kinematic_state"
CONTROL = "/control/command/control_cmd"
