# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Look up runs and their nodes by the names given on the command line."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.errors.suggestions import did_you_mean
from rmw_manycore_py.launch.runs.directory import RunDirectory, all_runs, runs_of
from rmw_manycore_py.launch.runs.up_command import up_command


def living_runs(platform: str) -> list[RunDirectory]:
    """Return the runs of a platform with live supervisors; raise ManycoreError if none."""
    runs = [run for run in runs_of(platform) if run.is_alive]
    if not runs:
        raise ManycoreError(no_run(platform))
    return runs


def no_run(platform: str) -> str:
    """Return the message that a platform has no run: its last one, and platforms that have one."""
    others = sorted({run.platform for run in all_runs() if run.is_alive} - {platform})
    hint = f"; there is {', '.join(others)} (--platform)" if others else ""
    last = "".join(f"; {end_of(run)}: {start_again(run)}" for run in runs_of(platform)[-1:])
    return f"platform '{platform}' is run by no `manycore run` or `manycore up`{last}{hint}"


def end_of(run: RunDirectory) -> str:
    """Return how a run has ended; when it was killed is known by its last sign of life only."""
    how = "has ended"
    if killed := run.killed_after:
        how = f"was killed at {killed.isoformat(timespec='seconds')} or later"
    return f"the run of {run.info.get('mapfile', 'a mapfile')} {how}"


def start_again(run: RunDirectory) -> str:
    """Return the command that starts the mapfile of an ended run again."""
    info = run.info
    command = up_command(info.get("mapfile", "MAPFILE"), info.get("host"), info.get("joins", False))
    return f"{command} starts it again"


def nodes_by_run(
    runs: Sequence[RunDirectory], names: Iterable[str]
) -> list[tuple[RunDirectory, list[str]]]:
    """Return the named nodes of each run; a leading slash in a name is optional."""
    chosen: dict[int, list[str]] = {}
    for name in dict.fromkeys(names):
        # If several runs had a node of this name, the latest run owns it.
        owners = [i for i, run in enumerate(runs) if _known_as(run, name)]
        if not owners:
            raise ManycoreError(_unknown(runs, name), EXIT_BAD_INPUT)
        chosen.setdefault(owners[-1], []).append(_known_as(runs[owners[-1]], name) or name)
    return [(runs[index], nodes) for index, nodes in chosen.items()]


def _known_as(run: RunDirectory, name: str) -> str | None:
    known = {node.lstrip("/"): node for node in run.nodes}
    return known.get(name.lstrip("/"))


def _unknown(runs: Sequence[RunDirectory], name: str) -> str:
    known = [node for run in runs for node in run.nodes]
    hint = did_you_mean(name, known) or f"; there is {', '.join(known) or 'none'}"
    return f"no node '{name}' in this run{hint}"
