# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Start times of nodes that a launch file delays or makes wait for another node."""

from __future__ import annotations

import time
from collections.abc import Iterable

from rmw_manycore_py.launch.processes.node_process import NodeProcess
from rmw_manycore_py.launch.processes.state import NodeState


def schedule(nodes: Iterable[NodeProcess]) -> None:
    """Set the start time of each node; nodes that wait for another have none yet."""
    for node in nodes:
        rules = node.program.rules
        if rules.after is not None:
            node.start_at_s = float("inf")
        elif rules.delay_s > 0:
            node.start_at_s = time.monotonic() + rules.delay_s


def schedule_late(nodes: Iterable[NodeProcess], node: NodeProcess) -> None:
    """Set the start time of a node that is added: it waits only for what is still to come."""
    rules = node.program.rules
    first = next((one for one in nodes if one.program.name == rules.after), None)
    node.start_at_s = time.monotonic() + rules.delay_s
    if first is not None and (
        first.is_wanted_again
        or first.state is NodeState.WAITING
        or (rules.after_exit and first.is_alive)
    ):
        node.start_at_s = float("inf")


def started(nodes: list[NodeProcess], node: NodeProcess) -> None:
    """Release nodes that wait for this start, and those repeated with it."""
    _release(nodes, node, after_exit=False)
    for index, one in enumerate(nodes):
        if _repeats_with(one, node):
            if one.is_over:
                nodes[index] = NodeProcess(one.next_program)
            one.is_wanted_again = one.is_alive


def ended(nodes: Iterable[NodeProcess], node: NodeProcess) -> None:
    """Release nodes that wait for this end; stop those that depend on the node."""
    _release(nodes, node, after_exit=True)
    for one in nodes:
        if _repeats_with(one, node) and one.state is NodeState.RUNNING and not one.is_leaderless:
            one.stop()


def _repeats_with(one: NodeProcess, node: NodeProcess) -> bool:
    return one.program.repeats and one.program.rules.after == node.program.name


def _release(nodes: Iterable[NodeProcess], node: NodeProcess, *, after_exit: bool) -> None:
    for one in nodes:
        rules = one.program.rules
        waits = one.state is NodeState.WAITING and rules.after == node.program.name
        if waits and rules.after_exit is after_exit:
            one.start_at_s = time.monotonic() + rules.delay_s


def respawned(node: NodeProcess) -> NodeProcess | None:
    """Return the process that replaces an ended one, if it is to be respawned."""
    rules = node.program.rules
    if node.is_held:
        return None
    if node.is_wanted_again:
        return node.successor()
    if rules.respawn_delay_s is None or 0 <= rules.max_respawns <= node.respawns:
        return None
    successor = NodeProcess(node.next_program)
    successor.respawns = node.respawns + 1
    successor.start_at_s = time.monotonic() + rules.respawn_delay_s
    return successor
