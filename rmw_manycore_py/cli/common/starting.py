# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options and set-up shared by `manycore run` and `manycore up`."""

from __future__ import annotations

import difflib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.cli.common.finite_range import FiniteRange
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.launch.platform import occupied_cores
from rmw_manycore_py.launch.run import Mode, Run
from rmw_manycore_py.launch.timekeeper import VirtualTime
from rmw_manycore_py.mapfile import Mapfile, Placement, load_mapfile, resolve


def starting_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add --join and --node to a command."""
    node = click.option(
        "--node",
        "nodes",
        metavar="NODE",
        multiple=True,
        help="Start only this node of MAPFILE; may be repeated.",
    )
    join = click.option(
        "--join", "joins", is_flag=True, help="Add the nodes to a platform that is already running."
    )
    return join(node(command))


def prepared_run(
    mapfile: Path,
    joins: bool,
    nodes: tuple[str, ...],
    detached: bool = False,
    virtual: VirtualTime | None = None,
) -> tuple[Run, Placement]:
    """Return the run of a mapfile or of some of its nodes, without starting it."""
    loaded = _only(load_mapfile(mapfile), nodes)
    if loaded.sections.clock == "virtual" and virtual is None:
        virtual = VirtualTime(factor=1.0)
    if virtual is not None and joins:
        text = "--join: the platform that is running lives in wall time, not in virtual time"
        raise ManycoreError(text, EXIT_BAD_INPUT)
    occupied = occupied_cores(loaded.platform_name) if joins else ()
    placement = resolve(loaded, occupied)
    return Run(placement, Mode(loaded, joins, detached, bool(nodes), virtual)), placement


def virtual_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add --virtual, --instant and --factor to a command."""
    virtual = click.option(
        "--virtual",
        is_flag=True,
        help="Run in virtual time, which passes only while all nodes wait.",
    )
    instant = click.option(
        "--instant", is_flag=True, help="In virtual time, callbacks take no time."
    )
    factor = click.option(
        "--factor",
        type=FiniteRange(min=0, min_open=True),
        metavar="F",
        help="In virtual time, callbacks take F times their CPU time; 1 by default.",
    )
    return virtual(instant(factor(command)))


def virtual_time(virtual: bool, instant: bool, factor: float | None) -> VirtualTime | None:
    """Return what the options of `virtual_options` ask for."""
    if instant and factor is not None:
        raise click.UsageError("--instant and --factor exclude each other.")
    if not (virtual or instant or factor is not None):
        return None
    return VirtualTime(0.0 if instant else factor or 1.0)


def _only(mapfile: Mapfile, names: tuple[str, ...]) -> Mapfile:
    """Return a mapfile reduced to some of its nodes."""
    if not names:
        return mapfile
    nodes = mapfile.sections.nodes
    known = {name.lstrip("/"): name for name in nodes}
    for name in names:
        if name.lstrip("/") not in known:
            close = difflib.get_close_matches(name, nodes, n=1)
            hint = f"is {close[0]} meant?" if close else f"it has {', '.join(sorted(nodes))}"
            text = f"--node: no node '{name}' in {mapfile.path}; {hint}"
            raise ManycoreError(text, EXIT_BAD_INPUT)
    wanted = {known[name.lstrip("/")] for name in names}
    return mapfile.only(wanted)
