# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A launched node: its state, its process group, and its output."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable

from rmw_manycore_py.launch.processes.birth import pinned_to
from rmw_manycore_py.launch.processes.ending import (
    KILLED_AS_ASKED,
    Ending,
    judge,
    not_started,
    was_killed,
)
from rmw_manycore_py.launch.processes.output import OutputReader
from rmw_manycore_py.launch.processes.program import NodeProgram
from rmw_manycore_py.launch.processes.state import STOP_STEPS, NodeState, check_transition
from rmw_manycore_py.launch.processes.terminal import Pipe, Terminal, before_exec
from rmw_manycore_py.process.parent_death import dies_with_this_process
from rmw_manycore_py.process.readiness import Readiness
from rmw_manycore_py.process.scheduling import scheduled_as

# How long the children of a node may keep printing after the node has ended.
ORPHAN_GRACE_S = 1.0


class NodeProcess:
    """All processes of a node are in one process group, whose id is the node's pid.

    The node is reaped last: until then the kernel does not reuse the pid, so a signal to the group
    cannot hit another process.
    """

    def __init__(self, program: NodeProgram) -> None:
        self.program = program
        self.next_program = program  # of the process that replaces this one
        self.state = NodeState.WAITING
        self.ending: Ending | None = None
        self.deadline_s = float("inf")  # CLOCK_MONOTONIC, when the next step is due
        self.start_at_s = 0.0  # CLOCK_MONOTONIC, earliest and later actual start
        self.respawns = 0  # number of earlier processes of the node
        self.is_wanted_again = False  # a new process replaces it when it is over
        self.is_held = False  # stopped by request: not respawned, the run continues
        self.is_removed = False  # held, and no node of the run any more
        self.is_killed_as_asked = False  # at a virtual time: not a failure
        self.was_asked_for = False  # restarted by request: a failing start does not end the run
        self.pidfd = -1  # open while the node runs
        self.came_up = not program.supervised  # supervised processes report it
        self.failed_starts = 0  # number of earlier processes that ended before coming up
        self._process: subprocess.Popen[bytes] | None = None
        self._output: OutputReader | None = None
        self._readiness: Readiness | None = None

    @property
    def process(self) -> subprocess.Popen[bytes]:
        """Process of a started node."""
        assert self._process is not None
        return self._process

    @property
    def output(self) -> OutputReader:
        """Output of a started node."""
        assert self._output is not None
        return self._output

    @property
    def last_lines(self) -> tuple[str, ...]:
        """Last lines printed by the node."""
        return tuple(self._output.tail) if self._output else ()

    @property
    def is_alive(self) -> bool:
        """Return whether the node was started and is not over."""
        return self.state in (
            NodeState.RUNNING,
            NodeState.INTERRUPTED,
            NodeState.TERMINATED,
            NodeState.KILLED,
        )

    @property
    def is_being_stopped(self) -> bool:
        """Return whether the node was asked to end and is not over."""
        return self.is_alive and self.state is not NodeState.RUNNING

    @property
    def is_over(self) -> bool:
        """Return whether the node is in a final state."""
        return self.state in (NodeState.FINISHED, NodeState.FAILED)

    def start(self, tap: Callable[[bytes], None] | None = None) -> bool:
        """Start the node on its CPUs; on failure, set the ending and return False.

        :param tap: receives the node's output as it arrives.
        """
        self.start_at_s = time.monotonic()
        if self.program.supervised:
            self._readiness = Readiness()
        try:
            streams = Terminal() if self.program.terminal else Pipe()
            try:
                self._process = self._spawned(streams)
            except BaseException:
                streams.discard()
                raise
        except OSError as error:
            self._end(not_started(error))
            return False
        self._output = OutputReader(streams.opened(), tap)
        self._become(NodeState.RUNNING)
        self.pidfd = os.pidfd_open(self._process.pid)
        return True

    def _spawned(self, streams: Pipe) -> subprocess.Popen[bytes]:
        with pinned_to(self.program.host_cpus), scheduled_as(self.program.scheduling):
            return subprocess.Popen(
                self.program.command,
                env={**self.program.environment, **self._readiness_variables()},
                cwd=self.program.directory,
                bufsize=0,
                start_new_session=True,
                pass_fds=[self._readiness.fd] if self._readiness else [],
                preexec_fn=before_exec(dies_with_this_process(), streams),
                **streams.options,
            )

    def stop(self) -> signal.Signals | None:
        """Take the next step of stopping the node; return the signal that was sent."""
        step = STOP_STEPS.get(self.state)
        if step is None:
            return None
        self._signal_group(step.signal)
        self._become(step.state)
        self.deadline_s = time.monotonic() + step.grace_s
        return step.signal

    def withdraw(self) -> None:
        """Cancel a node that is waiting to be started."""
        self._end(Ending(False, "not started"))

    def successor(self) -> NodeProcess:
        """Return the process that replaces this one on request."""
        successor = NodeProcess(self.next_program)
        successor.respawns = self.respawns
        successor.was_asked_for = True
        return successor

    def replace_program(self, program: NodeProgram) -> None:
        """Set the program of the next start."""
        self.next_program = program
        if self.state is NodeState.WAITING:
            self.program = program

    def leader_ended(self) -> None:
        """Record that the node has ended; its children get a short time to finish output."""
        os.close(self.pidfd)
        self.pidfd = -1
        self.deadline_s = time.monotonic() + ORPHAN_GRACE_S

    @property
    def is_leaderless(self) -> bool:
        """Return whether the node has ended but is not reaped yet."""
        return self.is_alive and self.pidfd < 0

    def collect(self) -> list[str]:
        """Kill the rest of the group, reap the node and judge its status; return the last lines."""
        self._signal_group(signal.SIGKILL)
        lines = self.output.close()
        return_code = self.process.wait()
        if self._readiness:
            self.came_up = self._readiness.close()
            self._readiness = None
        if self.is_killed_as_asked and was_killed(return_code):
            self._end(KILLED_AS_ASKED)
        else:
            self._end(judge(return_code, self.state, self.last_lines, self.came_up))
        return lines

    def destroy(self) -> None:
        """Kill and reap everything of the node, in any state."""
        if self.is_alive:
            self._signal_group(signal.SIGKILL)
            self.process.wait()
            self.output.close()
        if self.pidfd >= 0:
            os.close(self.pidfd)
        if self._readiness:
            self._readiness.close()

    def _readiness_variables(self) -> dict[str, str]:
        return self._readiness.variables if self._readiness else {}

    def _signal_group(self, number: signal.Signals) -> None:
        os.killpg(self.process.pid, number)

    def _become(self, state: NodeState) -> None:
        check_transition(self.state, state)
        self.state = state

    def _end(self, ending: Ending) -> None:
        self.ending = ending
        self.deadline_s = float("inf")
        self._become(NodeState.FAILED if ending.failed else NodeState.FINISHED)
