# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The states of a launched node."""

import pytest

from rmw_manycore_py.launch.processes.state import (
    STOP_STEPS,
    TRANSITIONS,
    NodeState,
    check_transition,
)

pytestmark = pytest.mark.unit


def test_every_state_has_its_row() -> None:
    assert set(TRANSITIONS) == set(NodeState)


def test_every_stop_step_is_a_transition() -> None:
    for state, step in STOP_STEPS.items():
        check_transition(state, step.state)


def test_a_node_that_is_over_stays_so() -> None:
    for state in (NodeState.FINISHED, NodeState.FAILED):
        with pytest.raises(ValueError, match=f"from {state.value} to running"):
            check_transition(state, NodeState.RUNNING)


def test_stopping_always_comes_to_an_end() -> None:
    state = NodeState.RUNNING
    for _ in STOP_STEPS:
        state = STOP_STEPS[state].state
    assert state is NodeState.KILLED
    assert TRANSITIONS[state] == {NodeState.FAILED}
