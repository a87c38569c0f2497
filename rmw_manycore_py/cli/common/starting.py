# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Options and set-up shared by `manycore run` and `manycore up`."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.cli.common.finite_range import FiniteRange, WholeRange
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.errors.missing_library import SIMPY, require
from rmw_manycore_py.errors.suggestions import did_you_mean
from rmw_manycore_py.launch.platform import occupied_cores
from rmw_manycore_py.launch.run import Mode, Run
from rmw_manycore_py.launch.timekeeper import PlatformModel, VirtualTime
from rmw_manycore_py.mapfile import Mapfile, Placement, load_mapfile, resolve


def starting_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add --host, --join and --node to a command."""
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
    host = click.option("--host", metavar="HOST", help="Start only HOST's part of MAPFILE.")
    return host(join(node(command)))


def prepared_run(
    mapfile: Path,
    joins: bool,
    nodes: tuple[str, ...],
    detached: bool = False,
    virtual: VirtualTime | None = None,
    host: str | None = None,
) -> tuple[Run, Placement]:
    """Return the run of a mapfile, of a host's part, or of some nodes, without starting it."""
    loaded = load_mapfile(mapfile)
    if host is not None:
        loaded = _of_host(loaded, host)
    loaded = _only(loaded, nodes)
    if virtual is not None and virtual.kills:
        victims, times_s = zip(*virtual.kills, strict=True)
        kills = zip(_names_of("--kill", loaded, victims), times_s, strict=True)
        virtual = replace(virtual, kills=tuple(kills))
    mode = Mode(loaded, joins, detached, bool(nodes), virtual)
    if mode.virtual is not None and host is not None:
        text = "--host: hosts have no common virtual time; without it, all nodes run on this one"
        raise ManycoreError(text, EXIT_BAD_INPUT)
    if mode.virtual is not None and joins:
        text = "--join: the platform that is running lives in wall time, not in virtual time"
        raise ManycoreError(text, EXIT_BAD_INPUT)
    occupied = occupied_cores(loaded.platform_name) if joins else ()
    placement = resolve(loaded, occupied)
    if joins:  # the run that is there has the links to other hosts
        placement = replace(placement, links=())
    return Run(placement, mode), placement


def virtual_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add --virtual and how long callbacks take to a command."""
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
    profile = click.option(
        "--profile",
        type=click.Path(exists=True, dir_okay=False, path_type=Path),
        help="In virtual time, callbacks take the times of this profile, on the --platform.",
    )
    platform = click.option(
        "--platform",
        "platform_name",
        metavar="NAME",
        help="With --profile: host (default), coolidge, bostan, or a file.",
    )
    seed = click.option(
        "--seed",
        type=WholeRange(min=0),
        help="With --profile: seed of the random numbers, 0 by default.",
    )
    kills = click.option(
        "--kill",
        "kills",
        multiple=True,
        metavar="NODE@S",
        help="Kill a node after S seconds of virtual time. May be repeated.",
    )
    return virtual(instant(factor(profile(platform(seed(kills(command)))))))


def virtual_time(
    mapfile: Path,
    virtual: bool,
    instant: bool,
    factor: float | None,
    profile: Path | None,
    platform_name: str | None,
    seed: int | None,
    kills: tuple[str, ...],
) -> VirtualTime | None:
    """Return what the options of `virtual_options` ask for."""
    due = tuple(_kill_of(text) for text in kills)
    given = {"--instant": instant, "--factor": factor is not None, "--profile": bool(profile)}
    names = [name for name, is_given in given.items() if is_given]
    if len(names) > 1:
        raise click.UsageError(f"{' and '.join(names)} exclude each other.")
    if profile is not None:
        # Loaded when needed: most runs have no profile.
        require(SIMPY)
        from rmw_manycore_py.prediction.live import live_of

        model = PlatformModel(mapfile, profile, platform_name or "host", seed or 0)
        live_of(model.mapfile, model.profile, model.platform, model.seed)  # or the reason why not
        return VirtualTime(0.0, model, due)
    if platform_name is not None or seed is not None:
        text = "--platform and --seed need --profile; $MANYCORE_PLATFORM names the run's platform."
        raise click.UsageError(text)
    if not (virtual or names):
        if not kills:
            return None
        if load_mapfile(mapfile).sections.clock != "virtual":
            raise click.UsageError("--kill needs virtual time.")
    return VirtualTime(0.0 if instant else factor or 1.0, kills=due)


def _kill_of(text: str) -> tuple[str, float]:
    found = re.fullmatch(r"(.+)@(\d+(?:\.\d+)?)", text)
    if found is None:
        raise click.UsageError(f"--kill: expected NODE@SECONDS, found '{text}'.")
    return found[1], float(found[2])


def _of_host(mapfile: Mapfile, host: str) -> Mapfile:
    """Return the part of a mapfile that runs on a host."""
    hosts = mapfile.sections.hosts
    if host not in hosts:
        known = f"it has {', '.join(hosts)}" if hosts else "it has no section 'hosts'"
        text = f"--host: no host '{host}' in {mapfile.path}; {known}"
        raise ManycoreError(text, EXIT_BAD_INPUT)
    part = mapfile.of_host(host)
    if not part.sections.nodes:
        text = f"--host: {mapfile.path} places no node on the clusters of '{host}'"
        raise ManycoreError(text, EXIT_BAD_INPUT)
    return part


def _only(mapfile: Mapfile, names: tuple[str, ...]) -> Mapfile:
    """Return a mapfile reduced to some of its nodes."""
    return mapfile.only(set(_names_of("--node", mapfile, names))) if names else mapfile


def _names_of(option: str, mapfile: Mapfile, names: tuple[str, ...]) -> list[str]:
    """Return the nodes that an option names, as the mapfile has them; a leading slash is optional.

    :raises ManycoreError: if it has no such node.
    """
    nodes = mapfile.sections.nodes
    known = {name.lstrip("/"): name for name in nodes}
    for name in names:
        if name.lstrip("/") not in known:
            hint = did_you_mean(name, nodes) or f"; it has {', '.join(sorted(nodes))}"
            text = f"{option}: no node '{name}' in {mapfile.path}{hint}"
            raise ManycoreError(text, EXIT_BAD_INPUT)
    return [known[name.lstrip("/")] for name in names]
