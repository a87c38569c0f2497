# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench virtual`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from itertools import zip_longest
from pathlib import Path
from tempfile import TemporaryDirectory

import click

from rmw_manycore_py.bench.machine import machine_header
from rmw_manycore_py.bench.virtual import VirtualRun, runs_of
from rmw_manycore_py.bench.virtual_chains import ComparedChain, compared_chains
from rmw_manycore_py.cli.bench.driven import driven
from rmw_manycore_py.cli.common.duration import duration_option
from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples, json_option, number_option
from rmw_manycore_py.cli.common.printing import (
    echo,
    escaped,
    new_table,
    print_json,
    print_table,
)
from rmw_manycore_py.cli.common.seconds import Seconds
from rmw_manycore_py.errors import EXIT_FAILURE
from rmw_manycore_py.profile.files import load, save
from rmw_manycore_py.profile.medians import with_medians

MAX_DEVIATION = 0.02


@click.command(
    "virtual",
    epilog=examples(
        "manycore bench virtual autoware_reference --runs 100 --duration 10",
        "manycore bench virtual map.yaml --profile app.profile.json --platform coolidge",
        "manycore bench virtual map.yaml --profile app.profile.json --chains --runs 2",
        "manycore bench virtual autoware_reference --native --runs 2 --duration 60",
        "manycore bench virtual drive.mcap --runs 2 --duration 60",
    ),
)
@mapfile_argument()
@number_option("--runs", within=(2, None), default=6, help="Number of runs.")
@duration_option(10.0, "Length of a run, in virtual time.", endless=False)
@click.option(
    "--timeout", type=Seconds(endless=False), default=300.0, help="Wall time that a run may take."
)
@click.option(
    "--profile",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="As in `manycore run`; without it, callbacks take no time.",
)
@click.option(
    "--platform", "platform_name", default="host", metavar="NAME", help="As in `manycore run`."
)
@number_option("--seed", within=(0, None), default=0, help="As in `manycore run`.")
@click.option(
    "--chains",
    "with_chains",
    is_flag=True,
    help="With --profile: callbacks take its medians, and chains are compared with manycore "
    "simulate.",
)
@click.option("--native", is_flag=True, help="Native nodes; for autoware_reference.")
@click.option("--kill", "kills", multiple=True, metavar="NODE@S", help="As in `manycore run`.")
@json_option
def command(
    mapfile: Path,
    runs: int,
    duration_s: float,
    timeout: float,
    profile: Path | None,
    platform_name: str,
    seed: int,
    with_chains: bool,
    native: bool,
    kills: tuple[str, ...],
    as_json: bool,
) -> None:
    """Compare runs of MAPFILE in virtual time.

    In turn alone, beside three busy loops, and on one CPU. Compares what the nodes print, and each
    message with the virtual time at which it is published and taken. The exit status is 1 if a run
    differs from the first one, or with --chains the median of a chain by more than 2 % from the
    simulator's. The installed mapfiles ros_lite and whill get their vehicle as a node.

    MAPFILE may be a recording (.mcap): it is played to one subscription of each topic.
    """
    if with_chains and profile is None:
        raise click.UsageError("--chains needs --profile.")
    found = []
    chains: list[ComparedChain] = []
    with TemporaryDirectory() as name:
        directory = Path(name)
        complete = driven(mapfile, directory, native=native)
        options: list[str] = ["--instant"]
        if profile is not None:
            taken = _of_medians(profile, directory) if with_chains else profile
            options = ["--profile", str(taken), "--platform", platform_name, "--seed", str(seed)]
        options += [word for kill in kills for word in ("--kill", kill)]
        for one in runs_of(complete, options, runs, duration_s, timeout):
            found.append(one)
            if not as_json:
                echo(
                    f"run {len(found):3}, {one.condition:17}: {one.digest[:16]}, "
                    f"{one.published} published, {one.taken} taken, {one.lost} lost, "
                    f"{duration_s:g} s in {one.wall_s:.1f} s"
                )
        if with_chains:
            model = load(taken), platform_name, seed
            chains = [*compared_chains(found[0].trace, complete, *model, duration_s)]
    if as_json:
        rows = {
            "runs": [*map(_row, found)],
            "chains": [one.row() for one in chains],
            "first_difference": _first_difference(found),
        }
        print_json({"machine": machine_header(), **rows})
    else:
        _print(found, chains)
    same = all(one.digest == found[0].digest for one in found)
    near = all(one.deviation <= MAX_DEVIATION for one in chains)
    sys.exit(0 if same and near else EXIT_FAILURE)


def _of_medians(profile: Path, directory: Path) -> Path:
    path = directory / "medians.profile.json"
    save(with_medians(load(profile)), path)
    return path


def _print(found: Sequence[VirtualRun], chains: Sequence[ComparedChain]) -> None:
    same = sum(one.digest == found[0].digest for one in found)
    echo(f"{same} of {len(found)} runs are the same")
    if (difference := _first_difference(found)) is not None:
        echo(f"first difference, {difference}")
    if not chains:
        return
    table = new_table("#virtual us", "#simulated us", "#deviation", "chain")
    for chain in chains:
        times = (f"{one.quantile(0.5):.1f}" for one in (chain.virtual, chain.simulated))
        table.add_row(*times, f"{chain.deviation:.2%}", escaped(chain.name))
    print_table(table)


def _row(one: VirtualRun) -> dict[str, object]:
    return {
        "condition": one.condition,
        "digest": one.digest,
        "published": one.published,
        "taken": one.taken,
        "lost": one.lost,
        "wall_s": one.wall_s,
    }


def _first_difference(found: Sequence[VirtualRun]) -> str | None:
    first = found[0]
    for other in found:
        for ours, theirs in zip_longest(first.log, other.log, fillvalue="nothing"):
            if ours != theirs:
                return f"{other.condition}: '{theirs}' instead of '{ours}'"
    return None
