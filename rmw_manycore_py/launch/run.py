# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A complete run: platform up, nodes up, nodes down, platform down."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, ExitStack, closing, contextmanager, nullcontext
from dataclasses import dataclass, replace
from datetime import datetime, timezone
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.applying import Applier
from rmw_manycore_py.launch.bridge import bridge_programs
from rmw_manycore_py.launch.control import Control
from rmw_manycore_py.launch.events import Event, Finished, Notice, PlacedCore, Platform
from rmw_manycore_py.launch.helpers import helper_programs
from rmw_manycore_py.launch.log_keeper import LogKeeper
from rmw_manycore_py.launch.placing_again import Mapped, Task
from rmw_manycore_py.launch.platform import check_joined, configured_platform, remaining_users
from rmw_manycore_py.launch.processes.program import NodeProgram
from rmw_manycore_py.launch.programs import check_scheduling, programs_of, write_parameters
from rmw_manycore_py.launch.ros2_daemon import CURE, end_lone_daemons
from rmw_manycore_py.launch.runner import Report, Runner
from rmw_manycore_py.launch.runs.directory import OwnRun, new_run
from rmw_manycore_py.launch.timekeeper import VirtualTime, closed_notices, timekeeper
from rmw_manycore_py.launch.traced import traced
from rmw_manycore_py.mapfile import Mapfile
from rmw_manycore_py.mapfile.placing.placement import PARAMETERS, Placement
from rmw_manycore_py.platform.topology import RECEIVE_THREAD_CORE
from rmw_manycore_py.process.signals import SignalInbox, signal_inbox

RECEIVE_THREAD = "(receive thread)"  # node names have no spaces


@dataclass(frozen=True)
class Mode:
    """What a run was started from, and how.

    :param only: whether `mapfile` has only some of the file's nodes.
    :param virtual: how long callbacks take in virtual time; None: as they do, if the mapfile asks
        for virtual time, and otherwise the time is the wall clock's.
    """

    mapfile: Mapfile
    joins: bool = False
    detached: bool = False
    only: bool = False
    virtual: VirtualTime | None = None

    def __post_init__(self) -> None:
        if self.virtual is None and self.mapfile.sections.clock == "virtual":
            object.__setattr__(self, "virtual", VirtualTime(factor=1.0))


class Run:
    """Nodes and bridge of a placement, on a new or a running platform."""

    def __init__(self, placement: Placement, mode: Mode) -> None:
        self._placement = placement
        self._mode = mode
        self._bridge = [] if mode.virtual else bridge_programs(placement)
        self._helpers = helper_programs(placement)
        check_scheduling(placement)

    @property
    def program_names(self) -> list[str]:
        """Names under which the processes of the run print."""
        nodes = [node.name for node in self._placement.nodes]
        return [p.name for p in self._bridge] + nodes + [p.name for p in self._helpers]

    def run(
        self,
        report: Report,
        duration_s: float | None = None,
        all_started: Callable[[], None] | None = None,
        trace: Path | None = None,
    ) -> int:
        """Start all processes, wait until they have ended, and return the exit status.

        :param all_started: called once when every node that is due has been started.
        :param trace: file for a trace of the whole run.
        """
        with signal_inbox() as inbox, ExitStack() as stack:
            own = stack.enter_context(self._directory(report))
            parameters = stack.enter_context(_generated_files(self._placement, own))
            reports = _Reports(report, own)
            return self._run(inbox, parameters, reports, duration_s, all_started, trace)

    def _run(
        self,
        inbox: SignalInbox,
        parameters: Path,
        reports: _Reports,
        duration_s: float | None,
        all_started: Callable[[], None] | None,
        trace: Path | None,
    ) -> int:
        placement, report = self._placement, reports.report
        programs = [*self._bridge, *programs_of(placement, parameters)]
        # An absolute path: shells in other directories read it.
        mapfile = replace(self._mode.mapfile, path=self._mode.mapfile.path.absolute())
        task = Task(Mapped(mapfile, placement), self._mode.joins, only_known=self._mode.only)
        with ExitStack() as stack:
            runner = stack.enter_context(closing(Runner(programs, report)))
            applier = Applier(runner, task, parameters, reports.record)
            stack.enter_context(reports.kept(runner, self.program_names, applier))
            closed = closed_notices(placement) if self._mode.virtual else ()
            for text in (*placement.notices, *closed):
                report(Notice(text))
            with self._platform(report), self._traced(trace, report), self._clock(runner):
                report(_describe(placement, self._bridge))
                exit_status = self._run_nodes(runner, report, inbox, duration_s, all_started)
            if users := self._remaining_users():
                report(Notice(f"platform {placement.name} stays, used by {', '.join(users)}"))
            report(Finished(runner.failed, exit_status))
        return exit_status

    @staticmethod
    def _run_nodes(
        runner: Runner,
        report: Report,
        inbox: SignalInbox,
        duration_s: float | None,
        all_started: Callable[[], None] | None,
    ) -> int:
        try:
            return runner.run(inbox, duration_s, all_started)
        except Exception as error:  # in the background, only the log shows it
            report(Notice(f"the supervisor failed: {type(error).__name__}: {error}"))
            raise

    @contextmanager
    def _directory(self, report: Report) -> Iterator[OwnRun | None]:
        """Yield the run's directory; None if it cannot be created, and then there are no logs."""
        mode = self._mode
        info: dict[str, Any] = {
            "mapfile": str(mode.mapfile.path.resolve()),
            "names_platform": mode.mapfile.sections.platform.name is not None,
            "nodes": self.program_names,
            "detached": mode.detached,
            "joins": mode.joins,
            "host": mode.mapfile.host,
            "started": datetime.now(timezone.utc).isoformat(timespec="seconds"),
        }
        with ExitStack() as stack:
            own = None
            try:
                own = stack.enter_context(new_run(self._placement.name, info, mode.joins))
            except OSError as error:
                text = f"{error.filename or 'the directory of runs'}: {error.strerror}"
                if mode.detached:
                    advice = "set MANYCORE_STATE to a directory that can be written to"
                    raise ManycoreError(f"{text}; {advice}") from error
                report(Notice(f"{text}: no logs are kept, and other shells cannot stop this run"))
            yield own

    def _platform(self, report: Report) -> AbstractContextManager[Any]:
        if self._mode.joins:
            check_joined(self._placement)
            return nullcontext()
        for pid in end_lone_daemons(self._placement.name):
            report(
                Notice(
                    f"the ros2 daemon ({pid}) of an earlier run was stopped: it kept platform "
                    f"{self._placement.name} from being recreated; `{CURE}` also stops it"
                )
            )
        return configured_platform(self._placement)

    @contextmanager
    def _clock(self, runner: Runner) -> Iterator[None]:
        if self._mode.virtual is None:
            yield
            return
        with timekeeper(self._placement.name, self._mode.virtual) as keeper:
            runner.live_in(keeper, self._mode.virtual.kills)
            yield

    def _traced(self, path: Path | None, report: Report) -> AbstractContextManager[Any]:
        if path is None:
            return nullcontext()
        return traced(self._placement.name, path, lambda text: report(Notice(text)))

    def _remaining_users(self) -> list[str]:
        return [] if self._mode.joins else remaining_users(self._placement.name)


class _Reports:
    """Distributes events to the caller, the logs and clients."""

    def __init__(self, report: Report, own: OwnRun | None) -> None:
        self._report = report
        self._own = own
        self._logs: LogKeeper | None = None
        self._control: Control | None = None

    def report(self, event: Event) -> None:
        """Forward an event; the caller comes last, since it may raise."""
        if self._logs:
            self._logs.report(event)
        if self._control:
            self._control.report(event)
        self._report(event)

    def record(self, nodes: list[str]) -> None:
        """Store other names of the run's processes."""
        if self._own is not None:
            self._own.record(nodes)

    @contextmanager
    def kept(self, runner: Runner, names: list[str], applier: Applier) -> Iterator[None]:
        """Store logs and serve clients while the runner runs."""
        if self._own is None:
            yield
            return
        self._control = control = Control(self._own.listener, runner, applier)
        logs = LogKeeper(self._own.directory.logs, names, self._report, control.log_changed)
        self._logs = logs
        try:
            yield
        finally:
            self._logs = self._control = None
            control.close()
            logs.close()


@contextmanager
def _generated_files(placement: Placement, own: OwnRun | None) -> Iterator[Path]:
    """Write the parameter files of the nodes into the run's directory, or a temporary one."""
    with ExitStack() as stack:
        if own is None:
            directory = Path(stack.enter_context(TemporaryDirectory(prefix="manycore_")))
        else:
            directory = own.directory.path / PARAMETERS
        write_parameters(placement.nodes, directory)
        yield directory


def _describe(placement: Placement, bridge: Iterable[NodeProgram]) -> Platform:
    topology = placement.topology
    nodes = [PlacedCore(node.name, *node.place, node.host_cpu) for node in placement.nodes]
    workers = [
        PlacedCore(f"(worker of {node.name})", *core, cpu)
        for node in placement.nodes
        for core, cpu in node.workers
    ]
    crossing = [PlacedCore(one.name, *one.core, one.host_cpu) for one in bridge]
    receive_threads = [
        PlacedCore(RECEIVE_THREAD, *core, cpu)
        for core, cpu in placement.host_cpus.items()
        if core.core == RECEIVE_THREAD_CORE
    ]
    return Platform(
        name=placement.name,
        profile=topology.profile,
        clusters=len(topology.clusters),
        cores_per_cluster=topology.cores_per_cluster,
        smem_size=topology.smem_size,
        cores=(*nodes, *workers, *crossing, *receive_threads),
    )
