# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bench virtual`."""

from __future__ import annotations

import sys
from itertools import zip_longest
from pathlib import Path

import click

from rmw_manycore_py.bench.machine import machine_header
from rmw_manycore_py.bench.virtual import VirtualRun, runs_of
from rmw_manycore_py.cli.bench.driven import driven
from rmw_manycore_py.cli.common.duration import duration_option
from rmw_manycore_py.cli.common.mapfile_argument import mapfile_argument
from rmw_manycore_py.cli.common.options import examples, json_option, number_option
from rmw_manycore_py.cli.common.printing import echo, print_json
from rmw_manycore_py.cli.common.seconds import Seconds
from rmw_manycore_py.errors import EXIT_FAILURE


@click.command(
    "virtual",
    epilog=examples(
        "manycore bench virtual autoware_reference --runs 100 --duration 10",
        "manycore bench virtual map.yaml --profile app.profile.json --platform coolidge",
    ),
)
@mapfile_argument()
@number_option("--runs", within=(2, None), default=6, help="Number of runs.")
@duration_option(10.0, "Length of a run, in virtual time.")
@click.option("--timeout", type=Seconds(), default=300.0, help="Wall time that a run may take.")
@click.option(
    "--profile",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="As of manycore run; without it, callbacks take no time.",
)
@click.option("--platform", "platform_name", default="host", metavar="NAME", help="As of run.")
@number_option("--seed", within=(0, None), default=0, help="As of manycore run.")
@click.option("--kill", "kills", multiple=True, metavar="NODE@S", help="As of manycore run.")
@json_option
def command(
    mapfile: Path,
    runs: int,
    duration_s: float,
    timeout: float,
    profile: Path | None,
    platform_name: str,
    seed: int,
    kills: tuple[str, ...],
    as_json: bool,
) -> None:
    """Compare runs of MAPFILE in virtual time.

    In turn alone, beside three busy loops, and on one CPU. Compares what the nodes print, and each
    message with the virtual time at which it is published and taken. The exit status is 1 if a run
    differs from the first one. The installed mapfiles ros_lite and whill get their vehicle as a
    node.
    """
    options: list[str] = ["--instant"]
    if profile is not None:
        options = ["--profile", str(profile), "--platform", platform_name, "--seed", str(seed)]
    options += [word for kill in kills for word in ("--kill", kill)]
    found = []
    with driven(mapfile) as complete:
        for one in runs_of(complete, options, runs, duration_s, timeout):
            found.append(one)
            if not as_json:
                echo(
                    f"run {len(found):3}, {one.condition:17}: {one.digest[:16]}, "
                    f"{len(one.log)} events, {one.wall_s:.1f} s"
                )
    same = sum(one.digest == found[0].digest for one in found)
    if as_json:
        print_json({"machine": machine_header(), "runs": [_row(one) for one in found]})
    else:
        echo(f"{same} of {runs} runs are the same")
        for one in found:
            if one.digest != found[0].digest:
                echo(_first_difference(found[0], one))
                break
    sys.exit(0 if same == runs else EXIT_FAILURE)


def _row(one: VirtualRun) -> dict[str, object]:
    return {
        "condition": one.condition,
        "digest": one.digest,
        "events": len(one.log),
        "wall_s": one.wall_s,
    }


def _first_difference(first: VirtualRun, other: VirtualRun) -> str:
    pairs = zip_longest(first.log, other.log, fillvalue="nothing")
    ours, theirs = next(pair for pair in pairs if pair[0] != pair[1])
    return f"first difference, {other.condition}: '{theirs}' instead of '{ours}'"
