# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Watch nodes of a run start and stop at a client's request."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterator

from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.run_printer import RunPrinter
from rmw_manycore_py.errors import EXIT_FAILURE, ManycoreError
from rmw_manycore_py.launch.events import Ended, Finished, Restarting, Started, event_of
from rmw_manycore_py.launch.runs.client import Client
from rmw_manycore_py.launch.runs.directory import RunDirectory
from rmw_manycore_py.launch.runs.lines import Message
from rmw_manycore_py.launch.runs.up_command import up_command
from rmw_manycore_py.platform.texts import listed

# A program with a failing import exits after about 0.2 s.
LOOK_S = 1.0
_MAX_CHANGES = 4  # in one line


def checked_answer(client: Client) -> Message:
    """Return the answer to `apply` or `move`, which follows a first, empty one."""
    for message in client.messages():
        if "error" in message:
            raise ManycoreError(
                str(message["error"]), int(message.get("exit_status", EXIT_FAILURE))
            )
        return message
    raise ManycoreError("the run has ended before it answered")


def unapplied(run: RunDirectory) -> Iterator[str]:
    """Yield changes of a run's mapfile that are not applied."""
    mapfile = run.info.get("mapfile")
    with Client(run, "apply", check=True) as client:
        try:
            changes = checked_answer(client)["changes"]
        except ManycoreError as error:
            yield f"nodes restart as their run read {mapfile}; it cannot be applied now: {error}"
            return
    if changes:
        what = listed(changes, _MAX_CHANGES)
        command = up_command(mapfile, run.info.get("host"))
        yield f"{mapfile} differs from what runs: {what}; {command} applies it"


class NodeWatch:
    """Prints what happens to nodes until they have started or ended, and one second longer.

    :param starts: nodes that are to start.
    :param ends: nodes that are to end.
    """

    def __init__(
        self, run: RunDirectory, starts: Collection[str], ends: Collection[str] = ()
    ) -> None:
        self._names = {*starts, *ends}
        self._starts = set(starts)
        self._ends = set(ends)
        self._started: set[str] = set()
        self._failed = False
        self._is_finished = False
        self._platform = run.platform
        self._printer = RunPrinter(run.nodes)

    def follow(self, client: Client) -> int:
        """Watch the nodes; return the exit status."""
        for message in client.messages():
            self._take(message)
            if not (self._starts or self._ends):
                break
        if (self._starts or self._ends) and not self._is_finished:
            raise ManycoreError(f"the run of platform '{self._platform}' has ended")
        if self._started:
            self._look_on(client)
        return EXIT_FAILURE if self._failed or self._starts or self._ends else 0

    def _look_on(self, client: Client) -> None:
        """Watch for nodes that end again at once."""
        deadline = time.monotonic() + LOOK_S
        while not self._failed and (left_s := deadline - time.monotonic()) > 0:
            messages = client.take(left_s)
            if messages is None:
                return
            for message in messages:
                self._take(message)

    def _take(self, message: Message) -> None:
        event = event_of(message)
        name = getattr(event, "node", None)
        if event is None or (name is not None and name not in self._names):
            return
        self._printer.report(event)
        if isinstance(event, Started):
            self._starts.discard(event.node)
            self._started.add(event.node)
        elif isinstance(event, Finished):
            self._failed = self._is_finished = True
        elif isinstance(event, Ended | Restarting) and event.node in self._started:
            self._failed = True
            for line in event.last_lines:
                echo(f"    {line}", err=True)
        elif isinstance(event, Ended):
            self._failed |= event.node in self._starts  # the start failed
            self._starts.discard(event.node)
            self._ends.discard(event.node)
