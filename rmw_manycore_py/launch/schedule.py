# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Start times of nodes: after delays, and with the start or the end of another node."""

from __future__ import annotations

import time

from rmw_manycore_py.launch.processes.node_process import NodeProcess
from rmw_manycore_py.launch.processes.state import NodeState
from rmw_manycore_py.launch.timekeeper import Timekeeper


class Schedule:
    """When the nodes of a run start.

    :param nodes: those of the run, which replaces them.
    :ivar timekeeper: of the run; delays are of its time. None: they are of the wall clock's.
    """

    def __init__(self, nodes: list[NodeProcess]) -> None:
        self._nodes = nodes
        self.timekeeper: Timekeeper | None = None

    def begin(self) -> None:
        """Set the start time of each node; nodes that wait for another have none yet."""
        for node in self._nodes:
            rules = node.program.rules
            if rules.after is not None:
                node.start_at_s = float("inf")
            elif rules.delay_s > 0:
                self._start_in(node, rules.delay_s)

    def add(self, node: NodeProcess) -> None:
        """Set the start time of a node that is added: it waits only for what is still to come."""
        rules = node.program.rules
        first = next((one for one in self._nodes if one.program.name == rules.after), None)
        self._nodes.append(node)
        if first is not None and (
            first.is_wanted_again
            or first.state is NodeState.WAITING
            or (rules.after_exit and first.is_alive)
        ):
            node.start_at_s = float("inf")
        else:
            self._start_in(node, rules.delay_s)

    def started(self, node: NodeProcess) -> None:
        """Release nodes that wait for this start, and those repeated with it."""
        self._release(node, after_exit=False)
        for index, one in enumerate(self._nodes):
            if _repeats_with(one, node):
                if one.is_over:
                    self._nodes[index] = NodeProcess(one.next_program)
                    self._start_in(self._nodes[index], one.program.rules.delay_s)
                one.is_wanted_again = one.is_alive

    def ended(self, node: NodeProcess) -> None:
        """Release nodes that wait for this end; stop those that depend on the node."""
        self._release(node, after_exit=True)
        for one in self._nodes:
            if (
                _repeats_with(one, node)
                and one.state is NodeState.RUNNING
                and not one.is_leaderless
            ):
                one.stop()

    def respawn(self, node: NodeProcess) -> bool:
        """Replace an ended process by the next one, if it is to be respawned."""
        rules = node.program.rules
        if node.is_held:
            return False
        index = self._nodes.index(node)
        if node.is_wanted_again:
            self._nodes[index] = node.successor()
            return True
        if rules.respawn_delay_s is None or 0 <= rules.max_respawns <= node.respawns:
            return False
        successor = NodeProcess(node.next_program)
        successor.respawns = node.respawns + 1
        self._nodes[index] = successor
        self._start_in(successor, rules.respawn_delay_s)
        return True

    def due(self, rank: int) -> None:
        """Start a node whose delay has passed in virtual time, unless it was stopped meanwhile."""
        node = self._nodes[rank]
        if node.state is NodeState.WAITING:
            node.start_at_s = 0.0
        else:
            self.drop(node)

    def drop(self, node: NodeProcess) -> None:
        """Tell the timekeeper of a node that is over."""
        if self.timekeeper is not None:
            self.timekeeper.gone(self._nodes.index(node))

    def _start_in(self, node: NodeProcess, delay_s: float) -> None:
        if self.timekeeper is None:
            node.start_at_s = time.monotonic() + delay_s
        else:
            node.start_at_s = float("inf")
            self.timekeeper.start_in(self._nodes.index(node), delay_s)

    def _release(self, node: NodeProcess, *, after_exit: bool) -> None:
        for one in self._nodes:
            rules = one.program.rules
            waits = one.state is NodeState.WAITING and rules.after == node.program.name
            if waits and rules.after_exit is after_exit:
                self._start_in(one, rules.delay_s)


def _repeats_with(one: NodeProcess, node: NodeProcess) -> bool:
    return one.program.repeats and one.program.rules.after == node.program.name
