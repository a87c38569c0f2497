# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Places the nodes of a run again, in a process of its own.

Reading may take long, and imports packages that were installed after the run's start.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import NamedTuple, TypeAlias

from rmw_manycore_program import own_program
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError, MapfileError, reported
from rmw_manycore_py.launch.platform import check_joined, occupied_cores
from rmw_manycore_py.launch.programs import check_scheduling
from rmw_manycore_py.launch.runs.up_command import up_command
from rmw_manycore_py.mapfile import (
    BridgePlacement,
    Mapfile,
    PlacedNode,
    Placement,
    load_mapfile,
    resolve,
)
from rmw_manycore_py.mapfile.format.checks import check_placement
from rmw_manycore_py.mapfile.placing.cores import Kept
from rmw_manycore_py.platform.topology import Core
from rmw_manycore_py.process.parent_death import dies_with_this_process


@dataclass(frozen=True)
class Mapped:
    """A mapfile with its placement."""

    mapfile: Mapfile
    placement: Placement


class MovedNode(NamedTuple):
    """A node to move; without a core, to the first free one of the cluster."""

    name: str
    cluster: int
    core: int | None


@dataclass(frozen=True)
class Task:
    """What to place again.

    :param runs: what runs.
    :param joins: whether the run joined its platform.
    :param pids: processes of its nodes, whose cores are free for them.
    :param only_known: whether to leave out nodes that the run does not have.
    :param move: a node to move; else the mapfile is read again.
    """

    runs: Mapped
    joins: bool
    pids: frozenset[int] = frozenset()
    only_known: bool = False
    move: MovedNode | None = None

    def placed(self) -> Mapped:
        """Return what is to run.

        :raises ManycoreError: for an invalid mapfile or place, and for what a running platform
            keeps.
        """
        mapfile = self._moved(self.move) if self.move else self._read_again()
        occupied = self._occupied()
        kept = Kept.of(self.runs.mapfile, self.runs.placement)
        launch = self.runs.placement.launch if self.move else None
        placement = resolve(mapfile, occupied, kept=kept, launch=launch)
        old, new = self.runs.placement.bridge, placement.bridge
        if (old and _without_cores(old)) != (new and _without_cores(new)):
            raise self._kept("what is bridged")
        if self.joins:
            check_joined(placement)
        check_scheduling(placement)
        nodes = self._only_moved(self.move.name, placement) if self.move else placement.nodes
        return Mapped(
            mapfile, replace(placement, bridge=old, links=self.runs.placement.links, nodes=nodes)
        )

    def _read_again(self) -> Mapfile:
        old = self.runs.mapfile
        mapfile = load_mapfile(old.path)
        if old.host is not None:
            mapfile = self._of_host(mapfile, old.host)
        if self.only_known:
            mapfile = mapfile.only(old.sections.nodes)
        if mapfile.platform_name != self.runs.placement.name:
            raise self._kept("the platform's name")
        if not self.joins and mapfile.topology != old.topology:
            raise self._kept("the platform's shape")
        if not self.joins and mapfile.sections.topics != old.sections.topics:
            raise self._kept("the section 'topics'")
        if mapfile.sections.clock != old.sections.clock:
            raise self._kept("the clock")
        return mapfile

    def _of_host(self, mapfile: Mapfile, host: str) -> Mapfile:
        if mapfile.sections.hosts != self.runs.mapfile.sections.hosts:
            raise self._kept("the section 'hosts'")
        return mapfile.of_host(host)

    def _kept(self, what: str) -> ManycoreError:
        path, name = self.runs.mapfile.path, self.runs.placement.name
        again = up_command(path, self.runs.mapfile.host, self.joins)
        return ManycoreError(
            f"{path}: {what} has changed, which cannot be applied to a running platform; nothing "
            f"is applied: `manycore stop --platform {name}`, then {again}",
            EXIT_BAD_INPUT,
        )

    def _moved(self, move: MovedNode) -> Mapfile:
        mapfile = self.runs.mapfile
        nodes = mapfile.sections.nodes
        if move.core is not None and not mapfile.sections.allow_shared_cores:
            core = Core(move.cluster, move.core)
            if owner := self._owner(core, move.name):
                raise ManycoreError(f"{core} is that of '{owner}': move it first", EXIT_BAD_INPUT)
        own = mapfile.own_clusters
        if own is not None and move.cluster not in own:
            text = f"cluster {move.cluster} is of another host than '{mapfile.host}'"
            raise ManycoreError(text, EXIT_BAD_INPUT)
        place = {"cluster": move.cluster, "core": move.core}
        moved = mapfile.with_nodes({**nodes, move.name: nodes[move.name].model_copy(update=place)})
        if problems := [*check_placement(moved)]:
            raise MapfileError(*problems)
        return moved

    def _only_moved(self, name: str, placement: Placement) -> tuple[PlacedNode, ...]:
        """Return the nodes that run, with one at its new place: other files may have changed."""
        new = {node.name: node for node in placement.nodes}
        return tuple(new[n.name] if n.name == name else n for n in self.runs.placement.nodes)

    def _owner(self, core: Core, name: str) -> str | None:
        for node in self.runs.placement.nodes:
            cores = [node.place, *(worker for worker, _ in node.workers)]
            if core in cores and (node.name, core) != (name, node.place):
                return node.name
        return None

    def _occupied(self) -> set[Core]:
        """Return the cores of the bridge, and of processes that are not of this run."""
        placement = self.runs.placement
        lanes = [lane for one in placement.crossings for lane in one.cores]
        of_bridge = {core for lane in lanes for core in lane}
        own = {node.place for node in placement.nodes}
        return (occupied_cores(placement.name, self.pids) | of_bridge) - own


def _without_cores(bridge: BridgePlacement) -> tuple[object, ...]:
    return bridge.routes, bridge.host_cpus, len(bridge.cores)


Answer: TypeAlias = "Mapped | tuple[str, int]"  # or why there is none, with an exit status


class PlacingAgain:
    """The process; readable when it has ended."""

    def __init__(self, task: Task) -> None:
        self._answer = os.fdopen(os.memfd_create("placed"), "w+b")
        with os.fdopen(os.memfd_create("task"), "w+b") as given:
            pickle.dump(task, given)
            given.seek(0)
            self._process = subprocess.Popen(
                own_program(__name__),
                stdin=given,
                stdout=self._answer,
                start_new_session=True,
                preexec_fn=dies_with_this_process(),
            )
        self._pidfd = os.pidfd_open(self._process.pid)

    def fileno(self) -> int:
        """Return the descriptor that becomes readable."""
        return self._pidfd

    def result(self) -> Mapped:
        """Return the mapping to run; raise ManycoreError as `Task.placed` does."""
        self._process.wait()
        self._answer.seek(0)
        data = self._answer.read()
        if not data:
            status = self._process.returncode
            raise ManycoreError(f"the mapfile cannot be read again: the reader ended ({status})")
        answer: Answer = pickle.loads(data)
        if isinstance(answer, tuple):
            raise ManycoreError(*answer)
        return answer

    def close(self) -> None:
        """Kill the process if it runs, and close all descriptors."""
        with suppress(ProcessLookupError):
            self._process.kill()
        self._process.wait()
        os.close(self._pidfd)
        self._answer.close()


def main() -> None:
    """Read a task from standard input, and write the answer to standard output."""
    # Launch files may print.
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    task: Task = pickle.load(sys.stdin.buffer)
    answer: Answer
    try:
        answer = task.placed()
    except Exception as error:
        known = reported(error)
        if known is None:
            raise
        answer = (str(known), known.exit_status)
    with answers:
        pickle.dump(answer, answers)


if __name__ == "__main__":
    main()
