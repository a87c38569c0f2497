# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Why a node ended, and whether that is a failure."""

from __future__ import annotations

import re
import signal
from collections.abc import Sequence
from dataclasses import dataclass

from rmw_manycore_py.launch.processes.state import INTERRUPT_GRACE_S, TERMINATE_GRACE_S, NodeState

# Last lines of tracebacks in which rclpy turns an interrupt into something else, with any RMW:
# pybind11, if it arrives while an argument is converted or while the rclpy module is initialised
# (rpyutils then adds a line); rcl and rclpy, if rclpy's own signal handler has shut down the
# context between two calls or before the node's `rclpy.shutdown()`.
_PYBIND11 = re.compile(r"RuntimeError: Unable to convert call argument '\d+' to Python object\b.*")
_RCL = re.compile(
    r"rclpy\._rclpy_pybind11\.RCLError: .*"
    r"\b(context is (not valid|invalid)|rcl_shutdown already called on the given context)\b.*"
)
_NOT_INITIALIZED = re.compile(r"rclpy\.exceptions\.NotInitializedException: .*")
_IMPORT = "ImportError: initialization failed"
_NO_EXTENSION = re.compile(r"The C extension '.*/_rclpy_pybind11\.[^/]+' isn't present .*")
_RCLPY_FRAME = re.compile(r'\s*File ".*/rclpy/[^"]+", line \d+.*')
# The interrupt arrived while the interpreter was starting, before any line of the node.
_NO_INTERPRETER = "Fatal Python error: init_"
_INTERRUPTIONS = ("KeyboardInterrupt", "rclpy.executors.ExternalShutdownException")
_STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM)
_ENDED_ON_REQUEST = {
    status for number in _STOP_SIGNALS for status in (-number.value, 128 + number.value)
}


@dataclass(frozen=True)
class Ending:
    """How a process ended: `exit_status` or `signal`, with a textual `reason`."""

    failed: bool
    reason: str
    exit_status: int | None = None
    signal: str | None = None


KILLED_AS_ASKED = Ending(False, "killed as asked", signal=signal.SIGKILL.name)


def was_killed(return_code: int) -> bool:
    """Return whether a process was killed, or a shell whose last program was."""
    return return_code in (-signal.SIGKILL, 128 + signal.SIGKILL)


def judge(
    return_code: int, state: NodeState, last_lines: Sequence[str] = (), came_up: bool = True
) -> Ending:
    """Judge the return code (negative signal number, as in subprocess) of a node in `state`.

    If an interrupt ends Python other than by the signal, the status is 1 and only the last lines
    show why. A supervised process that ends before it `came_up` has failed.
    """
    asked = state in (NodeState.INTERRUPTED, NodeState.TERMINATED)
    if asked and return_code == 1 and _was_interrupted(last_lines):
        return Ending(False, "stopped", exit_status=return_code)
    if state is NodeState.KILLED:
        return Ending(True, _stubborn(), signal=_signal_name(signal.SIGKILL))
    if asked and return_code in (0, *_ENDED_ON_REQUEST):
        failed, why = False, "stopped"
    elif return_code == 0 and came_up:
        failed, why = False, "finished"
    else:
        failed, why = True, _describe(return_code)
    if return_code < 0:
        return Ending(failed, why, signal=_signal_name(-return_code))
    return Ending(failed, why, exit_status=return_code)


def is_rclpys(traceback: Sequence[str]) -> bool:
    """Return whether the last lines are an error that rclpy raises for some interrupts."""
    last_line = next(reversed(traceback), "")
    if _RCL.fullmatch(last_line) or _NOT_INITIALIZED.fullmatch(last_line):
        return True
    if _NO_EXTENSION.fullmatch(last_line):
        return _IMPORT in traceback[-2:]
    in_rclpy = any(_RCLPY_FRAME.fullmatch(line) for line in traceback)
    return in_rclpy and _PYBIND11.fullmatch(last_line) is not None


def _was_interrupted(last_lines: Sequence[str]) -> bool:
    if any(line.startswith(_NO_INTERPRETER) for line in last_lines):
        return True
    return next(reversed(last_lines), "") in _INTERRUPTIONS or is_rclpys(last_lines)


def not_started(error: OSError) -> Ending:
    """Return the ending of a node that could not be started."""
    what = f": {error.filename}" if error.filename else ""
    return Ending(True, f"could not be started: {error.strerror}{what}")


def _describe(return_code: int) -> str:
    if return_code >= 0:
        return f"exit status {return_code}"
    return f"killed by {_signal_name(-return_code)} ({signal.strsignal(-return_code)})"


def _stubborn() -> str:
    return (
        f"did not stop within {INTERRUPT_GRACE_S:g} s of SIGINT "
        f"and {TERMINATE_GRACE_S:g} s of SIGTERM, and was killed"
    )


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"  # real-time signals have no names
