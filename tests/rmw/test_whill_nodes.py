# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The wheelchair's control nodes on the test's clock: what they forward, when they stop it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from autoware_control_msgs.msg import Control
from autoware_planning_msgs.msg import Trajectory as TrajectoryMessage
from autoware_vehicle_msgs.msg import Engage, GearCommand, VelocityReport
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Twist, TwistStamped, TwistWithCovarianceStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu
from std_srvs.srv import Trigger
from tier4_control_msgs.msg import GateMode
from tier4_external_api_msgs.msg import Emergency, Heartbeat
from tier4_vehicle_msgs.msg import VehicleEmergencyStamped
from whill_msgs.msg import ModelCr2State

from rmw_manycore_py.papers.roslite2.course.shape import CourseShape
from rmw_manycore_py.papers.roslite2.messages import trajectory_message
from support.nodes.ros import spin_until
from support.nodes.scan_matching import ros_arguments
from support.peers.programs import forked_node
from support.processes.program import Program

Start = Callable[..., Program]
GATE = "/vehicle_cmd_gate/service"


class Bench:
    """A node under test, its inputs and outputs, and its clock."""

    def __init__(self, node: Node, start: Start, module: str, *parameters: str) -> None:
        self.node = node
        self.now_s = 1000.0
        self.heard: dict[str, list[Any]] = {}
        self._clock = node.create_publisher(Clock, "/clock", 10)
        self._inputs: dict[str, Any] = {}
        words = ros_arguments(["use_sim_time:=true", *parameters])
        self.program = start(forked_node(f"rmw_manycore_py.papers.roslite2.nodes.{module}", *words))
        spin_until(node, self._clock.get_subscription_count)

    def hear(self, kind: Any, topic: str) -> list[Any]:
        """Return the list to which the messages of a topic are appended."""
        heard = self.heard[topic] = []
        self.node.create_subscription(kind, topic, heard.append, 10)
        spin_until(self.node, lambda: self.node.count_publishers(topic))
        return heard

    def send(self, topic: str, message: Any) -> None:
        """Publish once the node has a matching subscription."""
        if topic not in self._inputs:
            self._inputs[topic] = self.node.create_publisher(type(message), topic, 10)
            spin_until(self.node, self._inputs[topic].get_subscription_count)
        self._inputs[topic].publish(message)

    def stamp(self, behind_s: float = 0.0) -> Any:
        """Return the current time, or an earlier one."""
        time_ns = round((self.now_s - behind_s) * 1e9)
        return Time(sec=time_ns // 10**9, nanosec=time_ns % 10**9)

    def tick(self, step_s: float = 0.02) -> None:
        """Advance the clock."""
        self.now_s += step_s
        self._clock.publish(Clock(clock=self.stamp()))

    def until(self, condition: Callable[[], Any], act: Callable[[], Any] = lambda: None) -> None:
        """Advance the clock, and act at each tick, until a condition holds."""

        def turn() -> Any:
            self.tick()
            act()
            return condition()

        spin_until(self.node, turn)


def control(
    bench: Bench, speed_m_s: float, steering_rad: float = 0.0, behind_s: float = 0.0
) -> Any:
    message = Control(stamp=bench.stamp(behind_s))
    message.longitudinal.velocity = speed_m_s
    message.lateral.steering_tire_angle = steering_rad
    return message


@pytest.fixture
def interface(node: Node, start: Start) -> Bench:
    """Return `whill_interface` in the gear DRIVE."""
    bench = Bench(node, start, "whill_interface")
    bench.hear(Twist, "/whill/controller/cmd_vel")
    bench.send("/control/command/gear_cmd", GearCommand(command=GearCommand.DRIVE))
    return bench


def twists_of(bench: Bench, act: Callable[[], Any], wanted: Callable[[Any], bool]) -> None:
    """Wait until a twist is as expected."""
    heard = bench.heard["/whill/controller/cmd_vel"]
    heard.clear()
    bench.until(lambda: any(wanted(twist) for twist in heard), act)


def test_the_interface_limits_speed_and_turns_as_a_bicycle(interface):
    command = "/control/command/control_cmd"
    twists_of(
        interface,
        lambda: interface.send(command, control(interface, 2.0, 0.3)),
        lambda t: (t.linear.x, t.angular.z) == pytest.approx((1.67, 1.67 * 0.3093362 / 0.45), 1e-5),
    )


def drive(interface: Bench, behind_s: float = 0.0) -> Callable[[], None]:
    """Return a function that sends the interface a command to drive at 1 m/s."""
    topic = "/control/command/control_cmd"
    return lambda: interface.send(topic, control(interface, 1.0, behind_s=behind_s))


@pytest.mark.parametrize("behind_s", [0.6, -0.6])
def test_the_interface_stands_with_commands_of_another_time(interface, behind_s):
    twists_of(interface, drive(interface), lambda twist: twist.linear.x == 1.0)
    twists_of(interface, drive(interface, behind_s), lambda twist: twist == Twist())
    assert "the newest control_cmd is" in interface.program.wait_for("commanding standstill").string


def test_the_interface_stands_in_park_and_in_an_emergency(interface):
    driving = drive(interface)
    moves, stands = (lambda twist: twist.linear.x == 1.0), (lambda twist: twist == Twist())
    twists_of(interface, driving, moves)
    interface.send("/control/command/gear_cmd", GearCommand(command=GearCommand.PARK))
    twists_of(interface, driving, stands)
    interface.send("/control/command/gear_cmd", GearCommand(command=GearCommand.DRIVE))
    twists_of(interface, driving, moves)
    emergency = VehicleEmergencyStamped(emergency=True)
    interface.send("/control/command/emergency_cmd", emergency)
    twists_of(interface, driving, stands)


def test_the_interface_reports_the_motion_of_the_motors(interface):
    reports = interface.hear(VelocityReport, "/vehicle/status/velocity_status")
    state = ModelCr2State(left_motor_speed=3.6, right_motor_speed=-5.4)
    interface.until(lambda: reports, lambda: interface.send("/whill/states/model_cr2", state))
    found = (reports[0].longitudinal_velocity, reports[0].heading_rate)
    assert found == pytest.approx((1.25, 1.0), abs=1e-6)


def test_the_gate_holds_passes_stops_and_is_cleared(node, start):
    bench = Bench(node, start, "vehicle_cmd_gate")
    commands = bench.hear(Control, "output/control_cmd")
    emergencies = bench.hear(VehicleEmergencyStamped, "output/vehicle_cmd_emergency")

    def beat() -> None:
        bench.send("input/external_emergency_stop_heartbeat", Heartbeat(stamp=bench.stamp()))
        command()

    def command() -> None:
        bench.send("input/auto/control_cmd", control(bench, 1.2, 0.1))

    def told(speed_m_s: float, acceleration_m_s2: float) -> Callable[[], bool]:
        commands.clear()
        wanted = pytest.approx((speed_m_s, acceleration_m_s2), abs=1e-6)
        return lambda: any(
            (one.longitudinal.velocity, one.longitudinal.acceleration) == wanted for one in commands
        )

    bench.until(told(0.0, -1.5), beat)  # not engaged: held
    bench.send("input/engage", Engage(engage=True))
    bench.until(told(1.2, 0.0), beat)
    bench.until(lambda: emergencies and not emergencies[-1].emergency, beat)
    bench.until(told(0.0, -2.4), command)  # without heartbeats
    bench.until(lambda: emergencies[-1].emergency, command)
    bench.program.wait_for("no external_emergency_stop_heartbeat for more than 0.5 s")
    clear = node.create_client(Trigger, f"{GATE}/clear_external_emergency_stop")
    assert clear.wait_for_service(30.0)
    answers: list[Any] = []

    def ask() -> None:
        beat()
        if not answers or (answers[-1].done() and not answers[-1].result().success):
            answers.append(clear.call_async(Trigger.Request()))

    bench.until(told(1.2, 0.0), ask)


def test_the_gate_passes_the_gear_and_publishes_its_state(node, start):
    bench = Bench(node, start, "vehicle_cmd_gate")
    gears = bench.hear(GearCommand, "output/gear_cmd")
    engagements, modes = (
        bench.hear(Engage, "output/engage"),
        bench.hear(GateMode, "output/gate_mode"),
    )
    stops = bench.hear(Emergency, "output/external_emergency")

    def beat() -> None:
        bench.send("input/external_emergency_stop_heartbeat", Heartbeat(stamp=bench.stamp()))
        bench.send("input/auto/control_cmd", control(bench, 1.2))
        bench.send("input/auto/gear_cmd", GearCommand(command=GearCommand.DRIVE))
        bench.send("input/external/gear_cmd", GearCommand(command=GearCommand.REVERSE))

    bench.until(lambda: gears and gears[-1].command == GearCommand.DRIVE, beat)
    bench.until(lambda: engagements and not engagements[-1].engage, beat)
    bench.send("input/engage", Engage(engage=True))
    bench.until(lambda: engagements[-1].engage, beat)
    bench.until(lambda: modes and modes[-1].data == GateMode.AUTO, beat)
    bench.until(lambda: stops and not stops[-1].emergency, beat)
    bench.send("input/gate_mode", GateMode(data=GateMode.EXTERNAL))
    bench.until(lambda: modes[-1].data == GateMode.EXTERNAL, beat)
    bench.until(lambda: gears[-1].command == GearCommand.REVERSE, beat)
    stop = node.create_client(Trigger, f"{GATE}/external_emergency_stop")
    assert stop.wait_for_service(30.0)
    stop.call_async(Trigger.Request())
    bench.until(lambda: stops[-1].emergency, beat)
    bench.until(lambda: gears[-1].command == GearCommand.NONE, beat)


@pytest.fixture
def follower(node: Node, start: Start) -> Bench:
    """Return `simple_trajectory_follower` with the default course."""
    bench = Bench(node, start, "simple_trajectory_follower")
    bench.hear(Control, "output/control_cmd")
    bench.send("input/trajectory", trajectory_message(CourseShape().trajectory(), "map"))
    return bench


def at(
    bench: Bench,
    y_m: float = 0.0,
    variance: float = 0.01,
    behind_s: float = 0.0,
    speed_variance: float = 0.01,
) -> Odometry:
    """Return the pose of the vehicle at x = 5 m, and its speed of 1.5 m/s."""
    odometry = Odometry()
    odometry.header.stamp = bench.stamp(behind_s)
    odometry.pose.pose.position.x, odometry.pose.pose.position.y = 5.0, y_m
    odometry.pose.covariance[0] = variance
    odometry.twist.twist.linear.x = 1.5
    odometry.twist.covariance[0] = speed_variance
    return odometry


def told_by(bench: Bench, odometry: Callable[[], Odometry], wanted: Callable[[Any], bool]) -> None:
    heard = bench.heard["output/control_cmd"]
    heard.clear()
    send = lambda: bench.send("input/kinematics", odometry())  # noqa: E731
    bench.until(lambda: any(wanted(one) for one in heard), send)


def test_the_follower_steers_back(follower):
    """0.2 m to the left at 1.5 m/s: L = 7.5 m, kp = 8 / 56.25."""
    steering = -8.0 / 7.5**2 * 0.2
    told_by(
        follower,
        lambda: at(follower, y_m=0.2),
        lambda one: (
            (one.longitudinal.velocity, one.lateral.steering_tire_angle)
            == pytest.approx((1.5, steering), abs=1e-5)
        ),
    )


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"behind_s": 5.0}, r"is 5\.\d\d s old"),  # and a busy node is some ticks behind
        ({"behind_s": -2.0}, "is -[12]"),
        ({"y_m": 9.0}, "the trajectory is 9.0 m away"),
        ({"variance": 4.0}, "the standard deviation of the position is 2.00 m"),
        ({"speed_variance": 2.25}, "the standard deviation of the speed is 1.50 m/s"),
        ({"y_m": float("nan")}, "the trajectory is nan m away"),
    ],
)
def test_the_follower_stands_where_the_pose_is_no_ground_to_drive_on(follower, wrong, said):
    told_by(follower, lambda: at(follower), lambda one: one.longitudinal.velocity == 1.5)
    told_by(follower, lambda: at(follower, **wrong), lambda one: one.longitudinal.velocity == 0.0)
    follower.program.wait_for(said)


def test_a_dead_filter_is_named(node, start, follower):
    filter_ = start(forked_node("rmw_manycore_py.ndt.nodes.ekf_localizer", *ros_arguments(
        [], ["ekf_odom:=input/kinematics"])))  # fmt: skip
    spin_until(node, lambda: node.count_publishers("ekf_twist"))  # the one before that is matched
    # The follower has heard of the filter once it has acted on a first message and a second one.
    told_by(follower, lambda: at(follower), lambda one: one.longitudinal.velocity == 1.5)
    told_by(follower, lambda: at(follower, y_m=9.0), lambda one: one.longitudinal.velocity == 0.0)
    filter_.kill()
    spin_until(node, lambda: "ekf_localizer is gone" in follower.program.output)


def test_the_odometer_refuses_old_speeds_and_forgets_the_bias_at_standstill(node, start):
    bench = Bench(node, start, "gyro_odometer")
    raw, corrected = bench.hear(TwistStamped, "twist_raw"), bench.hear(TwistStamped, "twist")

    def sense(speed_m_s: float, behind_s: float = 0.0) -> None:
        twist = TwistWithCovarianceStamped()
        twist.header.stamp = bench.stamp(behind_s)
        twist.twist.twist.linear.x = speed_m_s
        bench.send("vehicle/twist_with_covariance", twist)
        imu = Imu()
        imu.header.stamp = bench.stamp()
        imu.angular_velocity.z = 0.005
        bench.send("imu", imu)

    bench.until(lambda: corrected and raw, lambda: sense(0.005))
    bench.until(lambda: corrected[-1].twist.angular.z == 0.0, lambda: sense(0.005))
    assert raw[-1].twist.angular.z == 0.005
    bench.until(lambda: corrected[-1].twist.angular.z == 0.005, lambda: sense(0.5))
    bench.until(
        lambda: "s old, expected at most 0.2 s: no twist is published" in bench.program.output,
        lambda: sense(0.75, behind_s=0.5),
    )
    fresh = 0.25  # received after everything the old ones could have caused
    bench.until(lambda: corrected[-1].twist.linear.x == fresh, lambda: sense(fresh))
    assert all(one.twist.linear.x != 0.75 for one in raw + corrected)


def test_the_converter_keeps_the_header_and_scales(node, start):
    bench = Bench(node, start, "vehicle_velocity_converter", "speed_scale_factor:=1.5")
    heard = bench.hear(TwistWithCovarianceStamped, "twist_with_covariance")
    report = VelocityReport(longitudinal_velocity=2.0, heading_rate=0.25)
    report.header.frame_id, report.header.stamp.sec = "base_link", 7
    bench.until(lambda: heard, lambda: bench.send("velocity_status", report))
    assert heard[0].header == report.header
    twist = heard[0].twist.twist
    assert (twist.linear.x, twist.angular.z) == (3.0, 0.25)


def test_a_trajectory_reaches_those_that_come_late(node, start, tmp_path):
    from rmw_manycore_py.papers.roslite2.course.trajectory_file import write_trajectory
    from rmw_manycore_py.papers.roslite2.messages import trajectory_of

    way = CourseShape().trajectory()
    write_trajectory(tmp_path / "way.csv", way)
    module = "rmw_manycore_py.papers.roslite2.nodes.static_trajectory_publisher"
    arguments = ros_arguments([f"trajectory_path:={tmp_path / 'way.csv'}"])
    start(forked_node(module, *arguments)).wait_for("publishing 751 points")
    heard: list[Any] = []
    node.create_subscription(TrajectoryMessage, "trajectory", heard.append, 1)
    spin_until(node, lambda: heard)
    found = trajectory_of(heard[0])
    assert found.x_m == pytest.approx(way.x_m, abs=1e-3)
    assert found.yaw_rad == pytest.approx(way.yaw_rad, abs=1e-3)
    assert found.speed_m_s == pytest.approx(way.speed_m_s, abs=1e-3)


@pytest.mark.parametrize(
    ("module", "parameters", "said"),
    [
        ("static_trajectory_publisher", (), "trajectory_path: expected a file, found none"),
        ("static_trajectory_publisher", ("trajectory_path:=none.csv",), "cannot be read"),
        ("whill_interface", ("wheel_base:=0.0",), "wheel_base: expected more than 0, found 0.0"),
        ("simple_trajectory_follower", ("kinematics_timeout:=soon",), "expected a number"),
    ],
)
def test_wrong_parameters_end_a_node(start, module, parameters, said):
    program = start(
        forked_node(f"rmw_manycore_py.papers.roslite2.nodes.{module}", *ros_arguments(parameters))
    )
    assert program.wait() == 2
    assert said in program.output
