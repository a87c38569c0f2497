# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A launched node: its state, its process, the processes it started itself, its output."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable

from rmw_manycore_py.launch.processes.birth import pinned_to
from rmw_manycore_py.launch.processes.ending import Ending, judge, not_started
from rmw_manycore_py.launch.processes.output import OutputReader
from rmw_manycore_py.launch.processes.program import NodeProgram
from rmw_manycore_py.launch.processes.state import STOP_STEPS, NodeState, check_transition
from rmw_manycore_py.launch.processes.terminal import Pipe, Terminal, before_exec
from rmw_manycore_py.parent_death import dies_with_this_process
from rmw_manycore_py.readiness import Readiness
from rmw_manycore_py.scheduling import scheduled_as

# How long children of a node may go on printing after the node itself has ended.
ORPHAN_GRACE_S = 1.0


class NodeProcess:
    """Every process of a node is in one process group, whose number is the node's process id.

    The node's exit status is collected last: until then the kernel keeps the number for it, so a
    signal to the group cannot hit a stranger.
    """

    def __init__(self, program: NodeProgram) -> None:
        self.program = program
        self.state = NodeState.WAITING
        self.ending: Ending | None = None
        self.deadline_s = float("inf")  # on the monotonic clock: when the next step is due
        self.start_at_s = 0.0  # on the monotonic clock: not before, and later when it was started
        self.respawns = 0  # how many processes of the node there were before
        self.is_wanted_again = False  # its place is taken by a new process when it is over
        self.is_held = False  # a person has stopped it: it is not respawned, its run goes on
        self.was_asked_for = False  # a person has restarted it: the run outlives a failing start
        self.pidfd = -1  # open while the node itself runs
        self.came_up = not program.supervised  # a supervised process reports it; known at its end
        self.vain_starts = 0  # how many processes before it ended without having come up
        self._process: subprocess.Popen[bytes] | None = None
        self._output: OutputReader | None = None
        self._readiness: Readiness | None = None

    @property
    def process(self) -> subprocess.Popen[bytes]:
        """The process of a node that was started."""
        assert self._process is not None
        return self._process

    @property
    def output(self) -> OutputReader:
        """The output of a node that was started."""
        assert self._output is not None
        return self._output

    @property
    def last_lines(self) -> tuple[str, ...]:
        """The last lines the node printed."""
        return tuple(self._output.tail) if self._output else ()

    @property
    def is_alive(self) -> bool:
        """Tell whether the node was started and is not over."""
        return self.state in (
            NodeState.RUNNING,
            NodeState.INTERRUPTED,
            NodeState.TERMINATED,
            NodeState.KILLED,
        )

    @property
    def is_over(self) -> bool:
        """Tell whether nothing will happen to the node any more."""
        return self.state in (NodeState.FINISHED, NodeState.FAILED)

    def start(self, tap: Callable[[bytes], None] | None = None) -> bool:
        """Start the node on its CPU; where that fails the ending says why.

        :param tap: gets the node's output as it comes.
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
        """Give a waiting node up: its turn is not to come."""
        self._end(Ending(False, "not started"))

    def successor(self) -> NodeProcess:
        """Return the process that a person wants in the place of this one."""
        successor = NodeProcess(self.program)
        successor.respawns = self.respawns
        successor.was_asked_for = True
        return successor

    def leader_ended(self) -> None:
        """Note that the node itself ended; its children have a moment for their last words."""
        os.close(self.pidfd)
        self.pidfd = -1
        self.deadline_s = time.monotonic() + ORPHAN_GRACE_S

    @property
    def is_leaderless(self) -> bool:
        """Tell whether the node itself ended, while its exit status is not yet collected."""
        return self.is_alive and self.pidfd < 0

    def collect(self) -> list[str]:
        """End the rest of the group and judge the exit status; return the last lines."""
        self._signal_group(signal.SIGKILL)
        lines = self.output.close()
        return_code = self.process.wait()
        if self._readiness:
            self.came_up = self._readiness.close()
            self._readiness = None
        self._end(judge(return_code, self.state, self.last_lines, self.came_up))
        return lines

    def destroy(self) -> None:
        """Leave nothing of the node, whatever state it is in."""
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
