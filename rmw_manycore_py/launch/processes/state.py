# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""States of a launched node, and the steps for stopping it."""

from __future__ import annotations

import signal
from enum import Enum
from typing import NamedTuple

# rclpy nodes end about 0.1 s after SIGINT; the rest is for nodes that save data.
INTERRUPT_GRACE_S = 5.0
TERMINATE_GRACE_S = 3.0


class NodeState(Enum):
    """Life-cycle state of a launched node."""

    WAITING = "waiting"  # not started yet
    RUNNING = "running"
    INTERRUPTED = "interrupted"  # was sent SIGINT
    TERMINATED = "terminated"  # was sent SIGTERM
    KILLED = "killed"  # was sent SIGKILL
    FINISHED = "finished"  # ended successfully, by itself or on request
    FAILED = "failed"  # start failed, non-zero exit, or had to be killed


TRANSITIONS: dict[NodeState, frozenset[NodeState]] = {
    NodeState.WAITING: frozenset({NodeState.RUNNING, NodeState.FINISHED, NodeState.FAILED}),
    NodeState.RUNNING: frozenset({NodeState.INTERRUPTED, NodeState.FINISHED, NodeState.FAILED}),
    NodeState.INTERRUPTED: frozenset({NodeState.TERMINATED, NodeState.FINISHED, NodeState.FAILED}),
    NodeState.TERMINATED: frozenset({NodeState.KILLED, NodeState.FINISHED, NodeState.FAILED}),
    NodeState.KILLED: frozenset({NodeState.FAILED}),
    NodeState.FINISHED: frozenset(),
    NodeState.FAILED: frozenset(),
}


class StopStep(NamedTuple):
    """Signal that stops a node, and the time before the next step."""

    signal: signal.Signals
    state: NodeState
    grace_s: float


STOP_STEPS = {
    NodeState.RUNNING: StopStep(signal.SIGINT, NodeState.INTERRUPTED, INTERRUPT_GRACE_S),
    NodeState.INTERRUPTED: StopStep(signal.SIGTERM, NodeState.TERMINATED, TERMINATE_GRACE_S),
    NodeState.TERMINATED: StopStep(signal.SIGKILL, NodeState.KILLED, float("inf")),
}


def check_transition(old: NodeState, new: NodeState) -> None:
    """Raise ValueError for a transition that is not in the table."""
    if new not in TRANSITIONS[old]:
        raise ValueError(f"no transition from {old.value} to {new.value}")
