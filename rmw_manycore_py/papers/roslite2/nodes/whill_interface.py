# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`whill_interface`: converts Autoware's commands and the state of the wheelchair."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from autoware_control_msgs.msg import Control
from autoware_vehicle_msgs.msg import (
    ControlModeReport,
    GearCommand,
    GearReport,
    HazardLightsReport,
    SteeringReport,
    TurnIndicatorsReport,
    VelocityReport,
)
from geometry_msgs.msg import Twist
from rclpy.node import Node
from tier4_vehicle_msgs.msg import VehicleEmergencyStamped
from whill_msgs.msg import ModelCr2State

from rmw_manycore_py.ndt.messages.conversions import seconds
from rmw_manycore_py.ndt.nodes.support.clock import clock_s
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.log_throttle import ThrottledLog
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.ndt.nodes.support.watched import watched
from rmw_manycore_py.papers.roslite2.laws.odometry import (
    is_stale,
    speed_of_motors,
    steering_of_motion,
)
from rmw_manycore_py.papers.roslite2.laws.wheelchair import MAX_SPEED_M_S, wheelchair_twist

FRAME = "base_link"
REPORTED_GEARS = (GearCommand.PARK, GearCommand.REVERSE, GearCommand.DRIVE, GearCommand.LOW)


@dataclass(frozen=True)
class InterfaceParameters:
    """Parameters of tier4's adapter and of Autoware's vehicle information."""

    timeout_s: float = parameter("control_cmd_timeout_sec", 0.5, above=0.0)
    rate_hz: float = parameter("loop_rate", 50.0, min_value=1.0, max_value=1000.0)
    max_speed_m_s: float = parameter("vehicle_velocity_limit", MAX_SPEED_M_S, above=0.0)
    wheel_base_m: float = parameter("wheel_base", 0.45, above=0.0)
    tread_m: float = parameter("wheel_tread", 0.5, above=0.0)


class WhillInterface(Node):
    """Publishes at a fixed rate; a zero twist on timeout, in PARK and in an emergency."""

    def __init__(self) -> None:
        super().__init__("whill_interface")
        self._p = declare(self, InterfaceParameters)
        self._complain = ThrottledLog(self.get_logger().warning)
        self._control: Any = None
        self._gear: Any = None
        self._is_emergency = False
        self._advertise()
        self._subscribe()
        self.create_timer(1.0 / self._p.rate_hz, self._command)

    def _subscribe(self) -> None:
        self.create_subscription(
            Control,
            "/control/command/control_cmd",
            self._on_control,
            1,
            event_callbacks=watched(self, "/control/command/control_cmd"),
        )
        self.create_subscription(GearCommand, "/control/command/gear_cmd", self._on_gear, 1)
        self.create_subscription(
            VehicleEmergencyStamped, "/control/command/emergency_cmd", self._on_emergency, 1
        )
        self.create_subscription(
            ModelCr2State,
            "/whill/states/model_cr2",
            self._on_state,
            1,
            event_callbacks=watched(self, "/whill/states/model_cr2"),
        )

    def _advertise(self) -> None:
        self._twist = self.create_publisher(Twist, "/whill/controller/cmd_vel", 1)
        self._velocity = self.create_publisher(VelocityReport, "/vehicle/status/velocity_status", 1)
        self._steering = self.create_publisher(SteeringReport, "/vehicle/status/steering_status", 1)
        self._gears = self.create_publisher(GearReport, "/vehicle/status/gear_status", 1)
        self._mode = self.create_publisher(ControlModeReport, "/vehicle/status/control_mode", 1)
        kind = TurnIndicatorsReport
        self._indicators = self.create_publisher(kind, "/vehicle/status/turn_indicators_status", 1)
        self._hazard = self.create_publisher(
            HazardLightsReport, "/vehicle/status/hazard_lights_status", 1
        )

    def _on_control(self, message: Any) -> None:
        self._control = message

    def _on_gear(self, message: Any) -> None:
        self._gear = message
        report = GearReport(stamp=message.stamp)
        report.report = message.command if message.command in REPORTED_GEARS else GearReport.NONE
        self._gears.publish(report)

    def _on_emergency(self, message: Any) -> None:
        self._is_emergency = message.emergency

    def _command(self) -> None:
        if self._control is None or self._gear is None:
            missing = "control_cmd" if self._control is None else "gear_cmd"
            self._complain(f"waiting for /control/command/{missing}: no cmd_vel is published")
            return
        twist = Twist()
        if reason := self._reason_to_stand():
            self._complain(f"{reason}: commanding standstill")
        else:
            wanted_m_s = self._control.longitudinal.velocity
            if wanted_m_s > self._p.max_speed_m_s:
                limit = f"{self._p.max_speed_m_s:g} m/s"
                self._complain(f"control_cmd: {wanted_m_s:.2f} m/s is limited to {limit}")
            twist.linear.x, twist.angular.z = wheelchair_twist(
                wanted_m_s,
                self._control.lateral.steering_tire_angle,
                self._p.wheel_base_m,
                self._p.max_speed_m_s,
            )
        self._twist.publish(twist)

    def _reason_to_stand(self) -> str:
        """Return why the newest command is not followed; "" if it is."""
        if self._is_emergency:
            return "there is an emergency"
        if self._gear.command == GearCommand.PARK:
            return "the gear is PARK"
        stamp_s = seconds(self._control.stamp)
        now_s = clock_s(self)
        if is_stale(stamp_s, now_s, self._p.timeout_s):
            return (
                f"the newest control_cmd is {now_s - stamp_s:.2f} s old, expected at most "
                f"{self._p.timeout_s:g} s"
            )
        return ""

    def _on_state(self, state: Any) -> None:
        """Report the wheelchair's motion; lights and mode are constant, since it has none."""
        stamp = self.get_clock().now().to_msg()
        motors = (state.left_motor_speed, state.right_motor_speed)
        speed_m_s, yaw_rate_rad_s = speed_of_motors(*motors, self._p.tread_m)
        velocity = VelocityReport(longitudinal_velocity=speed_m_s, heading_rate=yaw_rate_rad_s)
        velocity.header.stamp, velocity.header.frame_id = stamp, FRAME
        self._velocity.publish(velocity)
        angle_rad = steering_of_motion(speed_m_s, yaw_rate_rad_s, self._p.wheel_base_m)
        self._steering.publish(SteeringReport(stamp=stamp, steering_tire_angle=angle_rad))
        self._mode.publish(ControlModeReport(stamp=stamp, mode=ControlModeReport.AUTONOMOUS))
        self._indicators.publish(
            TurnIndicatorsReport(stamp=stamp, report=TurnIndicatorsReport.DISABLE)
        )
        self._hazard.publish(HazardLightsReport(stamp=stamp, report=HazardLightsReport.DISABLE))
        if state.error:
            self._complain(f"the wheelchair reports error {state.error}")


def main() -> None:
    """Run the node until interrupted."""
    run_node(WhillInterface)


if __name__ == "__main__":
    main()
