# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How the end of a node is judged and described."""

import signal

import pytest

from rmw_manycore_py.launch.processes.ending import judge, not_started
from rmw_manycore_py.launch.processes.state import NodeState

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(
    ("return_code", "state", "failed", "reason"),
    [
        (0, NodeState.RUNNING, False, "finished"),
        (3, NodeState.RUNNING, True, "exit status 3"),
        (-signal.SIGINT, NodeState.RUNNING, True, "killed by SIGINT (Interrupt)"),
        (-signal.SIGSEGV, NodeState.RUNNING, True, "killed by SIGSEGV (Segmentation fault)"),
        (0, NodeState.INTERRUPTED, False, "stopped"),
        (-signal.SIGINT, NodeState.INTERRUPTED, False, "stopped"),
        (130, NodeState.INTERRUPTED, False, "stopped"),
        (-signal.SIGTERM, NodeState.TERMINATED, False, "stopped"),
        (143, NodeState.TERMINATED, False, "stopped"),
        (1, NodeState.INTERRUPTED, True, "exit status 1"),
        (-signal.SIGABRT, NodeState.INTERRUPTED, True, "killed by SIGABRT (Aborted)"),
    ],
)
def test_judgement(return_code: int, state: NodeState, failed: bool, reason: str) -> None:
    ending = judge(return_code, state)
    assert (ending.failed, ending.reason) == (failed, reason)


def test_what_was_to_stay_fails_when_it_ends_before_it_had_come_up() -> None:
    ending = judge(0, NodeState.RUNNING, came_up=False)
    assert (ending.failed, ending.reason) == (True, "exit status 0")
    assert not judge(0, NodeState.INTERRUPTED, came_up=False).failed


FRAME = '  File "/x/site-packages/rclpy/executors.py", line 396, in _take_subscription'
PYBIND11 = (
    "RuntimeError: Unable to convert call argument '0' to Python object (#define "
    "PYBIND11_DETAILED_ERROR_MESSAGES or compile in debug mode for details)"
)
NO_EXTENSION = (
    "The C extension '/x/site-packages/_rclpy_pybind11.cpython-312.so' isn't present on the system."
    " Please refer to 'https://docs.ros.org/' for possible solutions"
)
RCL = "rclpy._rclpy_pybind11.RCLError: failed to "


@pytest.mark.parametrize(
    "last_lines",
    [
        ["KeyboardInterrupt"],
        ["rclpy.executors.ExternalShutdownException"],
        [FRAME, PYBIND11],
        [
            f"{RCL}initialize wait set: the given context is not valid, either rcl_init() was not "
            "called or rcl_shutdown() was called., at wait.c:130"
        ],
        [f"{RCL}shutdown: rcl_shutdown already called on the given context, at init.c:333"],
        [f"{RCL}create service: rcl node's context is invalid, at /src/rcl/node.c:404"],
        [f"{RCL}publish: publisher's context is invalid, at /src/rcl/publisher.c:423"],
        [
            "rclpy.exceptions.NotInitializedException: "
            "('rclpy.init() has not been called', 'cannot create node')"
        ],
        ["ImportError: initialization failed", NO_EXTENSION],
        [
            "Fatal Python error: init_sys_streams: can't initialize sys standard streams",
            "Python runtime state: core initialized",
            "TypeError: expected a message argument",
        ],
    ],
)
def test_python_that_an_interruption_ended_was_stopped(last_lines: list[str]) -> None:
    ending = judge(1, NodeState.INTERRUPTED, last_lines)
    assert (ending.failed, ending.reason) == (False, "stopped")
    assert judge(1, NodeState.RUNNING, last_lines).failed
    assert judge(2, NodeState.INTERRUPTED, last_lines).failed


@pytest.mark.parametrize(
    "last_lines",
    [
        [FRAME, "RuntimeError: Unable to reach the motor"],
        ['  File "/x/motor/driver.py", line 3, in stop', PYBIND11],
        [f"{RCL}publish: the arm is not there"],
        ["ImportError: libyaml.so: cannot open shared object file", NO_EXTENSION],
        ["ImportError: initialization failed"],
    ],
)
def test_another_error_on_the_way_out_is_a_failure(last_lines: list[str]) -> None:
    assert judge(1, NodeState.INTERRUPTED, last_lines).failed


def test_one_that_had_to_be_killed_failed() -> None:
    ending = judge(-signal.SIGKILL, NodeState.KILLED)
    assert (ending.failed, ending.signal, ending.exit_status) == (True, "SIGKILL", None)
    assert "did not stop within 5 s of SIGINT and 3 s of SIGTERM" in ending.reason


def test_real_time_signals_have_numbers() -> None:
    assert "signal 40" in judge(-40, NodeState.RUNNING).reason


def test_a_missing_program_is_named() -> None:
    error = FileNotFoundError(2, "No such file or directory", "no-such-program")
    reason = not_started(error).reason
    assert reason == "could not be started: No such file or directory: no-such-program"
