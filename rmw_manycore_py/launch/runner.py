# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Event loop of `manycore run`: one thread for output, exits, signals and deadlines."""

from __future__ import annotations

import selectors
import time
from collections import defaultdict
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from typing import Protocol

from rmw_manycore_py.errors import EXIT_FAILURE, ManycoreError
from rmw_manycore_py.launch.events import (
    Ended,
    Event,
    Output,
    Restarting,
    SignalEscalated,
    Started,
    Stopping,
)
from rmw_manycore_py.launch.processes.node_process import NodeProcess
from rmw_manycore_py.launch.processes.program import NodeProgram
from rmw_manycore_py.launch.processes.state import NodeState
from rmw_manycore_py.launch.schedule import Schedule
from rmw_manycore_py.launch.timekeeper import Timekeeper
from rmw_manycore_py.process.signals import SignalInbox
from rmw_manycore_py.process.waits import wait_until_s

Report = Callable[[Event], None]
Handler = Callable[[], None]

# Restart period of a supervised process that keeps ending.
RESTART_PAUSE_S = 1.0
# After this many consecutive processes that ended before coming up, stop restarting.
MAX_FAILED_STARTS = 3


class Readable(Protocol):
    """Object with a file descriptor, for a selector."""

    def fileno(self) -> int:
        """Return the descriptor."""


class Runner:
    """Starts nodes in order, one per loop iteration, and runs until the last one is over."""

    def __init__(self, programs: Sequence[NodeProgram], report: Report) -> None:
        self._nodes = [NodeProcess(program) for program in programs]
        self._report_to = report
        self._selector = selectors.DefaultSelector()
        self._stopping = False
        self._silent = False
        self._is_timed = False
        self._is_broken = False  # nodes did not live in virtual time to the end
        self._all_started: Handler | None = None
        self._end_s = float("inf")  # CLOCK_MONOTONIC, end of the run's duration
        self._timekeeper: Timekeeper | None = None
        self._schedule = Schedule(self._nodes)
        # Output callbacks by node name.
        self.taps: defaultdict[str, list[Callable[[bytes], None]]] = defaultdict(list)

    @property
    def nodes(self) -> Sequence[NodeProcess]:
        """Latest process of each program."""
        return self._nodes

    def node(self, name: str) -> NodeProcess:
        """Return the latest process of a program; raise ManycoreError for an unknown name."""
        for node in self._nodes:
            if node.program.name == name:
                return node
        raise ManycoreError(f"no node '{name}' in this run")

    def live_in(self, keeper: Timekeeper, kills: Sequence[tuple[str, float]]) -> None:
        """Run the nodes in virtual time, `kills` as in VirtualTime; call before they start."""
        self._timekeeper = self._schedule.timekeeper = keeper
        for name, after_s in kills:
            keeper.kill(self._nodes.index(self.node(name)), after_s)
        for rank, node in enumerate(self._nodes):
            environment = keeper.environment(node.program.environment, rank)
            node.replace_program(replace(node.program, environment=environment))
        self.watch(keeper, self._hear_timekeeper)

    @property
    def timekeeper(self) -> Timekeeper | None:
        """What keeps the time of the nodes; None: it is the wall clock's."""
        return self._timekeeper

    @property
    def is_stopping(self) -> bool:
        """Return whether the run is ending."""
        return self._stopping

    @property
    def failed(self) -> tuple[str, ...]:
        """Names of the nodes that failed."""
        return tuple(n.program.name for n in self._nodes if n.state is NodeState.FAILED)

    def run(
        self,
        inbox: SignalInbox,
        duration_s: float | None = None,
        all_started: Handler | None = None,
    ) -> int:
        """Run until all nodes are over or `duration_s` after the last start; return the status.

        A signal before the first node ends the run without starting any.

        :param all_started: called once when every node that is due has been started.
        """
        self._all_started = all_started
        with ExitStack() as stack:
            stack.callback(self._destroy_all)
            self.watch(inbox, lambda: self._take_signals(inbox))
            self._take_signals(inbox)
            self._schedule.begin()
            while not self._is_over():
                self._start_next(duration_s)
                self._end_without_nodes()
                for key, _ in sorted(self._selector.select(self._timeout_s()), key=self._is_later):
                    handler: Handler = key.data
                    handler()
                self._keep_deadlines()
        return EXIT_FAILURE if self.failed or self._is_broken else 0

    def close(self) -> None:
        """Close the selector."""
        self._selector.close()

    def _is_later(self, ready: tuple[selectors.SelectorKey, int]) -> bool:
        """Return whether to handle what the timekeeper reports before this: why a node ended."""
        return ready[0].fileobj is not self._timekeeper

    def _destroy_all(self) -> None:
        for node in self._nodes:
            node.destroy()

    def _is_over(self) -> bool:
        if self._stopping:
            return not any(node.is_alive for node in self._nodes)
        return all(node.is_over and not node.is_held for node in self._nodes)

    def _next_node(self) -> NodeProcess | None:
        now_s = time.monotonic()
        waiting = (node for node in self._nodes if node.state is NodeState.WAITING)
        due = (node for node in waiting if node.start_at_s <= now_s and not self._is_left(node))
        return None if self._stopping else next(due, None)

    def _is_left(self, node: NodeProcess) -> bool:
        """Return whether another node on the core of a node is about to end."""
        core = node.program.core
        nodes = (one for one in self._nodes if not one.program.repeats)
        return any(one.is_being_stopped and one.program.core == core for one in nodes)

    def _start_next(self, duration_s: float | None) -> None:
        node = self._next_node()
        if node is None:
            return
        if node.start(lambda data: self._tap(node.program.name, data)):
            if self._timekeeper is not None:
                rank = self._nodes.index(node)
                self._timekeeper.started(rank, node.process.pid, node.program.name)
            self._watch_node(node)
            self._schedule.started(node)
        else:
            self._report_end(node)
            if not node.was_asked_for:
                self._stop(f"{node.program.name} {node.ending.reason}" if node.ending else "")
        if not self._is_timed and self._next_node() is None:
            self._is_timed = True
            if self._timekeeper is not None:
                self._timekeeper.begin(duration_s)
            elif duration_s is not None:
                self._end_s = time.monotonic() + duration_s
            if self._all_started is not None and not self._stopping:
                self._all_started()

    def _tap(self, name: str, data: bytes) -> None:
        for tap in tuple(self.taps[name]):
            tap(data)

    def _watch_node(self, node: NodeProcess) -> None:
        core = node.program.core
        self.report(Started(node.program.name, node.process.pid, *core, node.program.host_cpu))
        self.watch(node.output, lambda: self._read_output(node))
        self._selector.register(node.pidfd, selectors.EVENT_READ, lambda: self._leader_ended(node))

    def watch(self, readable: Readable, handler: Handler) -> None:
        """Call a handler whenever `readable` has data."""
        self._selector.register(readable, selectors.EVENT_READ, handler)

    def watch_also_writable(self, readable: Readable, writable: bool) -> None:
        """Also call the handler when there is room to write, or stop doing so."""
        events = selectors.EVENT_READ | (selectors.EVENT_WRITE if writable else 0)
        self._selector.modify(readable, events, self._selector.get_key(readable).data)

    def unwatch(self, readable: Readable) -> None:
        """Undo `watch`."""
        self._selector.unregister(readable)

    def _read_output(self, node: NodeProcess) -> None:
        self._report_lines(node, node.output.read_lines())
        if node.output.at_end:
            self._selector.unregister(node.output)
            if node.is_leaderless:
                self._collect(node)

    def _leader_ended(self, node: NodeProcess) -> None:
        self._selector.unregister(node.pidfd)
        node.leader_ended()
        if node.output.at_end:
            self._collect(node)

    def _collect(self, node: NodeProcess) -> None:
        if not node.output.at_end:
            self._selector.unregister(node.output)
        self._report_lines(node, node.collect())
        if node.program.supervised and not self._stopping and not node.is_held:
            self._restart(node)
            return
        is_respawned = not self._stopping and self._schedule.respawn(node)
        self._schedule.ended(node)
        if is_respawned:
            assert node.ending is not None
            self.report(Restarting(node.program.name, node.ending.reason, node.last_lines))
        else:
            self._schedule.drop(node)
            self._report_end(node)
        if node.is_removed:
            self._nodes.remove(node)
        elif node.program.rules.ends_run and not (is_respawned or node.is_held):
            self._stop(f"{node.program.name} has ended")

    def _restart(self, node: NodeProcess) -> None:
        assert node.ending is not None
        failed_starts = 0 if node.came_up else node.failed_starts + 1
        if failed_starts == MAX_FAILED_STARTS:
            self._report_end(node)
            self._stop(f"{node.program.name} ended {failed_starts} times before it had come up")
            return
        self.report(Restarting(node.program.name, node.ending.reason, node.last_lines))
        successor = NodeProcess(node.program)
        successor.failed_starts = failed_starts
        successor.start_at_s = max(time.monotonic(), node.start_at_s + RESTART_PAUSE_S)
        self._nodes[self._nodes.index(node)] = successor

    def _end_without_nodes(self) -> None:
        """Stop supervised processes once the nodes they serve are over."""
        served = [node for node in self._nodes if not node.program.supervised]
        are_over = all(node.is_over and not node.is_held for node in served)
        if served and len(served) < len(self._nodes) and are_over:
            self._stop("all nodes have ended")

    def stop_all(self, reason: str) -> None:
        """Stop the run; a second call sends the next signal at once."""
        if self._stopping:
            self._insist(float("inf"))
        else:
            self._stop(reason)

    def stop_node(self, name: str) -> None:
        """Stop a node without ending the run; it is not respawned."""
        node = self.node(name)
        node.is_held, node.is_wanted_again = True, False
        if node.state is NodeState.WAITING:
            node.withdraw()
            self._schedule.drop(node)
            self._report_end(node)
        elif node.state is NodeState.RUNNING and not node.is_leaderless:
            node.stop()

    def restart_node(self, name: str, terminal: bool = False) -> None:
        """Restart a node, stopping it first if it runs.

        :param terminal: give it a terminal if it has none.
        """
        if self._stopping:
            raise ManycoreError("the run is stopping: cannot restart its nodes")
        node = self.node(name)
        if terminal:
            node.replace_program(replace(node.next_program, terminal=True))
        node.is_held = False
        if node.is_over:
            self._nodes[self._nodes.index(node)] = node.successor()
        elif node.state is NodeState.WAITING:
            node.start_at_s = 0.0
        else:
            node.is_wanted_again = True
            if node.state is NodeState.RUNNING and not node.is_leaderless:
                node.stop()

    def change_node(self, program: NodeProgram) -> None:
        """Restart a node as another program."""
        node = self.node(program.name)
        node.is_removed = False
        node.replace_program(program)
        self.restart_node(program.name)

    def add_node(self, program: NodeProgram) -> None:
        """Add a node, and start it as its rules allow."""
        if any(node.program.name == program.name for node in self._nodes):
            self.change_node(program)  # it was removed, and is about to end
            return
        node = NodeProcess(program)
        node.was_asked_for = True
        self._schedule.add(node)

    def remove_node(self, name: str) -> None:
        """Stop a node, and forget it when it has ended."""
        node = self.node(name)
        node.is_removed = True
        self.stop_node(name)
        if node.is_over:
            self._nodes.remove(node)

    def _take_signals(self, inbox: SignalInbox) -> None:
        for number in inbox.take():
            self.stop_all(number.name)

    def _stop(self, reason: str) -> None:
        if self._stopping:
            return
        self._stopping = True
        self.report(Stopping(reason))
        for node in self._nodes:
            if node.state is NodeState.RUNNING and not node.is_leaderless:
                node.stop()
        # After the signals: the nodes see them before they see time go on.
        if self._timekeeper is not None:
            self._timekeeper.end()

    def _hear_timekeeper(self) -> None:
        assert self._timekeeper is not None
        for report in self._timekeeper.read_reports():
            if report.event is not None:
                self.report(report.event)
                continue
            if report.kind == "killed":
                self._nodes[int(report.text)].is_killed_as_asked = True
                continue
            if report.kind == "due":
                self._schedule.due(int(report.text))
                continue
            if report.kind == "ended":
                self.unwatch(self._timekeeper)
            self._is_broken |= report.kind != "end" and not self._stopping
            self._stop(report.text)

    def _insist(self, now_s: float) -> None:
        """Send the next signal to each node whose grace period is over."""
        for node in self._nodes:
            if node.is_alive and not node.is_leaderless and node.deadline_s <= now_s:
                number = node.stop()
                if number:
                    self.report(SignalEscalated(node.program.name, number.name))

    def _keep_deadlines(self) -> None:
        now_s = time.monotonic()
        if now_s >= self._end_s:
            self._end_s = float("inf")
            self._stop("the duration is over")
        for node in tuple(self._nodes):
            if node.is_leaderless and now_s >= node.deadline_s:
                self._collect(node)
        self._insist(now_s)

    def _timeout_s(self) -> float | None:
        """Return the seconds until the next deadline; None if there is none."""
        if self._next_node() or self._is_over():
            return 0
        now_s = time.monotonic()
        waiting = (node for node in self._nodes if node.state is NodeState.WAITING)
        # A node that is due waits for another one to leave its core.
        starts = [node.start_at_s for node in waiting if node.start_at_s > now_s]
        return wait_until_s(min([self._end_s, *starts, *(node.deadline_s for node in self._nodes)]))

    def _report_lines(self, node: NodeProcess, lines: list[str]) -> None:
        for line in lines:
            self.report(Output(node.program.name, line))

    def _report_end(self, node: NodeProcess) -> None:
        ending = node.ending
        assert ending is not None
        tail = node.last_lines if ending.failed else ()
        name, state = node.program.name, node.state.value
        self.report(Ended(name, state, ending.reason, ending.exit_status, ending.signal, tail))

    def report(self, event: Event) -> None:
        """Report an event; stop the run if the output is closed."""
        if self._silent:
            return
        try:
            self._report_to(event)
        except OSError:  # a closed pipe, a terminal that hung up
            self._silent = True
            self._stop("the output was closed")
