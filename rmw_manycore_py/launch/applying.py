# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Applies a changed mapfile to a run, or moves one of its nodes (docs/design/control.md)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

from rmw_manycore_py.errors import EXIT_FAILURE, ManycoreError, reported
from rmw_manycore_py.launch.changes import Changes
from rmw_manycore_py.launch.connection import Connection
from rmw_manycore_py.launch.events import Notice
from rmw_manycore_py.launch.placing_again import Mapped, MovedNode, PlacingAgain, Task
from rmw_manycore_py.launch.processes.program import NodeProgram
from rmw_manycore_py.launch.programs import programs_of, write_parameters
from rmw_manycore_py.launch.requests import Apply, Move
from rmw_manycore_py.launch.runner import Runner
from rmw_manycore_py.launch.runs.up_command import up_command

Request = Apply | Move


class Applier:
    """Places nodes again at the request of clients, one request at a time.

    No node is stopped, and no file written, before all checks have passed.

    :param task: what runs, and how it is placed again.
    :param parameters: directory of generated files.
    :param record: stores the names of the run's processes for clients.
    """

    def __init__(
        self, runner: Runner, task: Task, parameters: Path, record: Callable[[list[str]], None]
    ) -> None:
        self._runner = runner
        self._task = task
        self._parameters = parameters
        self._record = record
        self._process: PlacingAgain | None = None
        self._client: Connection | None = None

    def begin(self, client: Connection, request: Request) -> None:
        """Check a request in a process of its own, whose end is an event of the runner."""
        if self._runner.timekeeper and not (isinstance(request, Apply) and request.check):
            raise ManycoreError(
                "the run is in virtual time, which begins with its nodes where they are: "
                "`manycore stop` it, and `up` again"
            )
        client.send({})  # the rest may take longer than clients wait for an answer
        if self._client is not None and not self._client.is_finished:
            raise ManycoreError("another change of this run is being checked: try again")
        self.close()
        task = self._task_of(request)
        self._process, self._client = PlacingAgain(task), client
        self._runner.watch(self._process, partial(self._end, client, request))

    def close(self) -> None:
        """End the check that is under way."""
        if self._process is not None:
            self._runner.unwatch(self._process)
            self._process.close()
            self._process = self._client = None

    def _task_of(self, request: Request) -> Task:
        nodes = [node for node in self._runner.nodes if not node.program.supervised]
        pids = frozenset(node.process.pid for node in nodes if node.is_alive)
        task = replace(self._task, pids=pids)
        if isinstance(request, Apply):
            return replace(task, only_known=task.only_known and request.check)
        places = {node.name: node.place for node in task.runs.placement.nodes}
        if (place := places.get(request.node)) is None:
            raise ManycoreError(f"no node '{request.node}' in this run")
        if (request.cluster, request.core) in (place, (place.cluster, None)):
            raise ManycoreError(f"'{request.node}' is on {place} already")
        return replace(task, move=MovedNode(request.node, request.cluster, request.core))

    def _end(self, client: Connection, request: Request) -> None:
        process, self._process, self._client = self._process, None, None
        assert process is not None
        self._runner.unwatch(process)
        try:
            if not client.is_finished:
                self._answer(client, request, process.result())
        except Exception as error:  # no request can end the run
            text = f"the request failed: {type(error).__name__}: {error}"
            known = reported(error) or ManycoreError(text, EXIT_FAILURE)
            client.finish({"error": str(known), "exit_status": known.exit_status})
        finally:
            process.close()

    def _answer(self, client: Connection, request: Request, placed: Mapped) -> None:
        changes = Changes.between(self._task.runs.placement, placed.placement)
        if isinstance(request, Apply) and request.check:
            client.finish({"changes": [*changes.lines()]})
            return
        if self._runner.is_stopping:
            raise ManycoreError("the run is stopping: cannot change its nodes")
        starts = [*changes.changed, *changes.added]
        write_parameters((n for n in placed.placement.nodes if n.name in starts), self._parameters)
        programs = programs_of(placed.placement, self._parameters)
        bridge = [node.program.name for node in self._runner.nodes if node.program.supervised]
        self._record([*bridge, *(program.name for program in programs)])
        ends = [name for name in changes.removed if self._runner.node(name).is_alive]
        over = {node.program.name for node in self._runner.nodes if node.is_over}
        stay = [n.name for n in placed.placement.nodes if n.name in over and n.name not in starts]
        client.send({"starts": starts, "ends": ends, "stay_ended": stay})
        client.wants_events = True
        for line in changes.lines():
            self._runner.report(Notice(line))
        if isinstance(request, Move):
            self._runner.report(Notice(_advice(request.node, placed)))
        self._task = replace(self._task, runs=placed)
        self._change(changes, {program.name: program for program in programs})

    def _change(self, changes: Changes, programs: Mapping[str, NodeProgram]) -> None:
        """Stop and start nodes; helpers start and end with the nodes they serve."""
        known = {node.program.name: node for node in self._runner.nodes}
        helpers = [name for name, node in known.items() if node.program.repeats]
        gone = [name for name in helpers if name not in programs]
        for name in (*changes.removed, *gone):
            self._runner.remove_node(name)
        for name in helpers:
            if name in programs:
                known[name].replace_program(programs[name])
        for name in changes.changed:
            self._runner.change_node(programs[name])
        for name, program in programs.items():
            if name not in known:
                self._runner.add_node(program)


def _advice(node: str, placed: Mapped) -> str:
    """Return how to keep a node where it was moved."""
    path = placed.mapfile.path
    command = up_command(path, placed.mapfile.host)
    line = placed.mapfile.document.line(("nodes", node, "cluster"))
    place = next(one.place for one in placed.placement.nodes if one.name == node)
    return (
        f"{path} is unchanged, and {command} moves {node} back: to keep it, write "
        f"`cluster: {place.cluster}`, `core: {place.core}` in line {line}"
    )
