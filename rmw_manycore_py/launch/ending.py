# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Why a node ended, and whether it ended well."""

from __future__ import annotations

import re
import signal
from dataclasses import dataclass

from rmw_manycore_py.launch.state import INTERRUPT_GRACE_S, TERMINATE_GRACE_S, NodeState

# How a traceback ends whose cause is the interruption. rclpy turns it into other errors: pybind11
# where it strikes while an argument is made, rcl where its own handler of the signal has shut the
# context down between two calls. Both happen with any RMW.
_INTERRUPTED_PYTHON = re.compile(
    r"KeyboardInterrupt"
    r"|rclpy\.executors\.ExternalShutdownException"
    r"|RuntimeError: Unable to convert call argument '\d+' to Python object\b.*"
    r"|rclpy\._rclpy_pybind11\.RCLError: .*\bthe given context is not valid\b.*"
)
_STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM)
_ENDED_ON_REQUEST = {
    status for number in _STOP_SIGNALS for status in (-number.value, 128 + number.value)
}


@dataclass(frozen=True)
class Ending:
    """How a process ended: `exit_status` or `signal`, in words in `reason`."""

    failed: bool
    reason: str
    exit_status: int | None = None
    signal: str | None = None


def judge(return_code: int, state: NodeState, last_line: str = "") -> Ending:
    """Judge the return code (minus a signal's number, as in subprocess) of a node in `state`.

    Python that an interruption ends otherwise than by the signal has status 1; only its last line
    says why.
    """
    asked = state in (NodeState.INTERRUPTED, NodeState.TERMINATED)
    if asked and return_code == 1 and _INTERRUPTED_PYTHON.fullmatch(last_line):
        return Ending(False, "stopped", exit_status=return_code)
    if state is NodeState.KILLED:
        return Ending(True, _stubborn(), signal=_signal_name(signal.SIGKILL))
    if return_code == 0 or (asked and return_code in _ENDED_ON_REQUEST):
        failed, why = False, "stopped" if asked else "finished"
    else:
        failed, why = True, _describe(return_code)
    if return_code < 0:
        return Ending(failed, why, signal=_signal_name(-return_code))
    return Ending(failed, why, exit_status=return_code)


def not_started(error: OSError) -> Ending:
    """Return the end of a node that never was."""
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
        return f"signal {number}"  # the real-time signals have no names
