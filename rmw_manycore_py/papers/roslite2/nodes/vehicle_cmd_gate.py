# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`vehicle_cmd_gate`: selects one command for the vehicle from planning and operators."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from autoware_adapi_v1_msgs.msg import MrmState, OperationModeState
from autoware_control_msgs.msg import Control
from autoware_vehicle_msgs.msg import (
    Engage,
    GearCommand,
    HazardLightsCommand,
    TurnIndicatorsCommand,
)
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_srvs.srv import Trigger
from tier4_control_msgs.msg import GateMode
from tier4_external_api_msgs.msg import Heartbeat, ResponseStatus
from tier4_external_api_msgs.srv import Engage as EngageService
from tier4_external_api_msgs.srv import SetEmergency

from rmw_manycore_py.ndt.nodes.support.clock import clock_s
from rmw_manycore_py.ndt.nodes.support.declared import declare, parameter
from rmw_manycore_py.ndt.nodes.support.log_throttle import ThrottledLog
from rmw_manycore_py.ndt.nodes.support.running import run_node
from rmw_manycore_py.ndt.nodes.support.watched import watched
from rmw_manycore_py.papers.roslite2.laws.gating import Gate, GateOptions, Passage, Source
from rmw_manycore_py.papers.roslite2.nodes.vehicle_cmd_gate_outputs import GateOutputs, StopLevels

MRM_AT_WORK = (MrmState.MRM_OPERATING, MrmState.MRM_SUCCEEDED, MrmState.MRM_FAILED)


@dataclass(frozen=True)
class GateParameters:
    """Autoware's parameters without its command filter: the interface limits the speed."""

    update_rate_hz: float = parameter("update_rate", 10.0, above=0.0, max_value=1000.0)
    watches_system: bool = parameter("use_emergency_handling", False)
    watches_external: bool = parameter("check_external_emergency_heartbeat", True)
    system_timeout_s: float = parameter("system_emergency_heartbeat_timeout", 0.5, min_value=0.0)
    external_timeout_s: float = parameter(
        "external_emergency_stop_heartbeat_timeout", 0.5, min_value=0.0
    )
    stop_hold_m_s2: float = parameter("stop_hold_acceleration", -1.5, max_value=0.0)
    emergency_m_s2: float = parameter("emergency_acceleration", -2.4, max_value=0.0)


class VehicleCmdGate(Node):
    """Forwards commands one by one; stops the vehicle if a heartbeat is late."""

    def __init__(self) -> None:
        super().__init__("vehicle_cmd_gate")
        self._p = declare(self, GateParameters)
        self._complain = ThrottledLog(self.get_logger().warning)
        self._gate = Gate(
            GateOptions(
                self._p.watches_external,
                self._p.watches_system,
                self._p.external_timeout_s,
                self._p.system_timeout_s,
            )
        )
        self._lights: dict[tuple[Source, str], Any] = {}
        self._outputs = GateOutputs(
            self, StopLevels(self._p.stop_hold_m_s2, self._p.emergency_m_s2)
        )
        self._subscribe_commands()
        self._subscribe_states()
        self._serve()
        self.create_timer(1.0 / self._p.update_rate_hz, self._tick)

    def _subscribe_commands(self) -> None:
        self.create_subscription(
            Control,
            "input/auto/control_cmd",
            lambda command: self._on_control(Source.AUTO, command),
            1,
            event_callbacks=watched(self, "input/auto/control_cmd"),
        )
        self.create_subscription(
            Control,
            "input/external/control_cmd",
            lambda command: self._on_control(Source.EXTERNAL, command),
            1,
        )
        self.create_subscription(
            Control,
            "input/emergency/control_cmd",
            lambda command: self._on_control(Source.EMERGENCY, command),
            1,
        )
        for source in Source:
            for kind, name in (
                (GearCommand, "gear_cmd"),
                (HazardLightsCommand, "hazard_lights_cmd"),
                (TurnIndicatorsCommand, "turn_indicators_cmd"),
            ):
                if (source, name) != (Source.EMERGENCY, "turn_indicators_cmd"):
                    topic = f"input/{source.value}/{name}"
                    self.create_subscription(kind, topic, self._light_handler(source, name), 1)

    def _subscribe_states(self) -> None:
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(
            Heartbeat,
            "input/external_emergency_stop_heartbeat",
            self._on_heartbeat,
            1,
            event_callbacks=watched(self, "input/external_emergency_stop_heartbeat"),
        )
        self.create_subscription(MrmState, "input/mrm_state", self._on_mrm_state, 1)
        self.create_subscription(GateMode, "input/gate_mode", self._on_gate_mode, 1)
        self.create_subscription(Engage, "input/engage", self._on_engage, 1)
        self.create_subscription(
            OperationModeState, "input/operation_mode", self._outputs.note_mode, kept
        )
        self.create_subscription(
            Odometry,
            "/localization/kinematic_state",
            self._on_kinematics,
            1,
            event_callbacks=watched(self, "/localization/kinematic_state"),
        )

    def _serve(self) -> None:
        for kind, name, answer in (
            (EngageService, "engage", self._on_engage_service),
            (SetEmergency, "external_emergency", self._on_emergency_service),
            (Trigger, "external_emergency_stop", self._on_stop_service),
            (Trigger, "clear_external_emergency_stop", self._on_clear_service),
        ):
            self.create_service(kind, f"~/service/{name}", answer)

    def _on_control(self, source: Source, command: Any) -> None:
        passage = self._gate.passage(source)
        if passage is not Passage.BLOCKED:
            is_emergency = source is Source.EMERGENCY
            self._outputs.pass_on(command, is_emergency, is_held=passage is Passage.HELD)

    def _light_handler(self, source: Source, name: str) -> Any:
        def keep(message: Any) -> None:
            self._lights[source, name] = message

        return keep

    def _tick(self) -> None:
        if missing := self._gate.missing():
            self._complain(f"waiting for {', '.join(missing)}: no command is forwarded")
            return
        if self._gate.tick(clock_s(self)):
            self._complain(self._reason_to_stop())
            self._outputs.stop()
        else:
            source = self._gate.wanted_source()
            lights = {name: one for (of, name), one in self._lights.items() if of is source}
            self._outputs.pass_lights(lights, self._gate.is_engaged or source is not Source.AUTO)
        self._outputs.publish_state(self._gate)

    def _reason_to_stop(self) -> str:
        if self._gate.is_external_late:
            return (
                "no external_emergency_stop_heartbeat for more than "
                f"{self._p.external_timeout_s:g} s: emergency stop"
            )
        if self._gate.is_system_late:
            return f"no mrm_state for more than {self._p.system_timeout_s:g} s: emergency stop"
        return "emergency stop: call ~/service/clear_external_emergency_stop to drive on"

    def _on_kinematics(self, _message: Any) -> None:
        """Do nothing: the subscription only serves to report a dead EKF, not a filter."""

    def _on_heartbeat(self, _message: Any) -> None:
        self._gate.external_heartbeat(clock_s(self))

    def _on_mrm_state(self, message: Any) -> None:
        is_stop = message.behavior == MrmState.EMERGENCY_STOP
        self._gate.system_state(clock_s(self), message.state in MRM_AT_WORK and is_stop)

    def _on_gate_mode(self, message: Any) -> None:
        sources = {GateMode.AUTO: Source.AUTO, GateMode.EXTERNAL: Source.EXTERNAL}
        if message.data not in sources:
            self._complain(f"input/gate_mode: expected 0 or 1, found {message.data}: ignored")
            return
        self._gate.source = sources[message.data]

    def _on_engage(self, message: Any) -> None:
        self._gate.is_engaged = message.engage

    def _on_engage_service(self, request: Any, response: Any) -> Any:
        self._gate.is_engaged = request.engage
        response.status.code = ResponseStatus.SUCCESS
        return response

    def _on_emergency_service(self, request: Any, response: Any) -> Any:
        answer = self._stop() if request.emergency else self._clear()
        code = ResponseStatus.SUCCESS if answer[0] else ResponseStatus.ERROR
        response.status.code, response.status.message = code, answer[1]
        return response

    def _on_stop_service(self, _request: Any, response: Any) -> Any:
        response.success, response.message = self._stop()
        return response

    def _on_clear_service(self, _request: Any, response: Any) -> Any:
        response.success, response.message = self._clear()
        return response

    def _stop(self) -> tuple[bool, str]:
        self._gate.stop()
        return True, "the vehicle is stopped"

    def _clear(self) -> tuple[bool, str]:
        if not self._gate.is_stopped:
            return False, "the vehicle is not stopped"
        if self._gate.clear():
            return True, "commands pass again"
        return False, "the heartbeat is still late"


def main() -> None:
    """Run the node until interrupted."""
    run_node(VehicleCmdGate)


if __name__ == "__main__":
    main()
