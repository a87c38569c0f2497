# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Outputs of `vehicle_cmd_gate`: commands and state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from autoware_adapi_v1_msgs.msg import OperationModeState
from autoware_control_msgs.msg import Control, Longitudinal
from autoware_vehicle_msgs.msg import (
    Engage,
    GearCommand,
    HazardLightsCommand,
    TurnIndicatorsCommand,
)
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from tier4_control_msgs.msg import GateMode
from tier4_external_api_msgs.msg import Emergency
from tier4_vehicle_msgs.msg import VehicleEmergencyStamped

from rmw_manycore_py.papers.roslite2.laws.gating import Gate, Source


@dataclass(frozen=True)
class StopLevels:
    """Accelerations of the two stop commands, m/s^2."""

    hold_m_s2: float
    emergency_m_s2: float


class GateOutputs:
    """Publishers of the gate, and the data for their messages."""

    def __init__(self, node: Node, levels: StopLevels) -> None:
        self._node = node
        self._levels = levels
        self._last = Control()
        self._mode = OperationModeState(mode=OperationModeState.STOP)
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        create = node.create_publisher
        self._emergency = create(VehicleEmergencyStamped, "output/vehicle_cmd_emergency", kept)
        self._control = create(Control, "output/control_cmd", kept)
        self._gear = create(GearCommand, "output/gear_cmd", kept)
        self._indicators = create(TurnIndicatorsCommand, "output/turn_indicators_cmd", kept)
        self._hazard = create(HazardLightsCommand, "output/hazard_lights_cmd", kept)
        self._gate_mode = create(GateMode, "output/gate_mode", kept)
        self._engage = create(Engage, "output/engage", kept)
        self._external = create(Emergency, "output/external_emergency", kept)
        self._operation_mode = create(OperationModeState, "output/operation_mode", kept)

    def note_mode(self, state: Any) -> None:
        """Store the operation mode, which the gate repeats."""
        self._mode = state

    def pass_on(self, command: Any, is_emergency: bool, is_held: bool) -> None:
        """Publish a command; if held, with its steering and zero speed."""
        if is_held:
            command.longitudinal = self._standing(self._levels.hold_m_s2)
        self._publish(command, is_emergency)

    def stop(self) -> None:
        """Publish the emergency command: last steering, zero speed, hazard lights."""
        stamp = self._now()
        command = Control(stamp=stamp, longitudinal=self._standing(self._levels.emergency_m_s2))
        command.lateral.stamp = stamp
        command.lateral.steering_tire_angle = self._last.lateral.steering_tire_angle
        self._publish(command, is_emergency=True)
        self._indicators.publish(TurnIndicatorsCommand(stamp=stamp))
        hazard = HazardLightsCommand(stamp=stamp, command=HazardLightsCommand.ENABLE)
        self._hazard.publish(hazard)
        self._gear.publish(GearCommand(stamp=stamp))

    def pass_lights(self, lights: dict[str, Any], is_engaged: bool) -> None:
        """Publish gear and lights of the source; lights only when engaged."""
        stamp = self._now()
        self._gear.publish(lights.get("gear_cmd", GearCommand(stamp=stamp)))
        for publisher, name, kind in (
            (self._hazard, "hazard_lights_cmd", HazardLightsCommand),
            (self._indicators, "turn_indicators_cmd", TurnIndicatorsCommand),
        ):
            command = lights.get(name) if is_engaged else None
            publisher.publish(kind(stamp=stamp) if command is None else command)

    def publish_state(self, gate: Gate) -> None:
        """Publish mode, engagement and emergency."""
        stamp = self._now()
        is_external = gate.source is Source.EXTERNAL
        mode = GateMode.EXTERNAL if is_external else GateMode.AUTO
        self._gate_mode.publish(GateMode(data=mode))
        self._engage.publish(Engage(stamp=stamp, engage=gate.is_engaged))
        self._external.publish(Emergency(stamp=stamp, emergency=gate.is_stopped))
        self._operation_mode.publish(self._mode)

    def _publish(self, command: Any, is_emergency: bool) -> None:
        emergency = VehicleEmergencyStamped(stamp=command.stamp, emergency=is_emergency)
        self._emergency.publish(emergency)
        self._control.publish(command)
        self._last = command

    def _standing(self, acceleration_m_s2: float) -> Any:
        return Longitudinal(stamp=self._now(), acceleration=acceleration_m_s2)

    def _now(self) -> Any:
        return self._node.get_clock().now().to_msg()
