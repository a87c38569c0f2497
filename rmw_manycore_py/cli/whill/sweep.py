# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore whill sweep`."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import click

from rmw_manycore_py.cli.common.duration import duration_option
from rmw_manycore_py.cli.common.finite_range import FiniteRange
from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, print_json
from rmw_manycore_py.cli.common.seconds import Seconds
from rmw_manycore_py.papers.roslite2.course.directory import VIRTUAL_MAPFILE
from rmw_manycore_py.papers.roslite2.sweep import Drive, sweep


@click.command(
    "sweep",
    epilog=examples(
        "manycore whill sweep --profile whill.profile.json",
        "manycore whill sweep --profile whill.profile.json --speed 0.25 --speed 0.18",
    ),
)
@click.option(
    "--course",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    default=Path("build/whill"),
    show_default=True,
    help="Directory written by 'manycore whill course'.",
)
@click.option(
    "--profile",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    required=True,
    help="Of the course's whill.yaml: 'manycore profile record'.",
)
@click.option("--platform", "platform_name", default="coolidge", metavar="NAME", help="As of run.")
@click.option(
    "--speed",
    "speeds",
    type=FiniteRange(min=0, min_open=True),
    multiple=True,
    default=(1.0, 0.5, 0.25, 0.18),
    show_default=True,
    help="Of the chip's cores, relative to the profile's machine. May be repeated.",
)
@duration_option(60.0, "Length of a drive, in virtual time.", endless=False)
@click.option(
    "--timeout",
    type=Seconds(endless=False),
    default=1800.0,
    help="Wall time that a drive may take.",
)
@json_option
def command(
    course: Path,
    profile: Path,
    platform_name: str,
    speeds: tuple[float, ...],
    duration_s: float,
    timeout: float,
    as_json: bool,
) -> None:
    """Drive on slower and slower chips, in virtual time.

    Shows from which speed on the path is lost; for which node messages wait longest, and which of
    its callbacks is to blame: the one that takes most of its time.
    """
    mapfile = course / VIRTUAL_MAPFILE
    drives = []
    for one in sweep(mapfile, profile, platform_name, speeds, duration_s, timeout):
        drives.append(one)
        if not as_json:
            _print(one)
    if as_json:
        print_json([asdict(one) for one in drives])
    else:
        _print_verdict(drives)


def _print(one: Drive) -> None:
    found = one.blamed
    echo(
        f"speed {one.speed:g}: {one.end}, {one.driven_m:.1f} m, at most {one.lateral_m_max:.2f} m "
        f"beside the path\n  {found.topic} waits {found.wait_ms:.1f} ms for {found.node}, where "
        f"{found.trigger} takes {found.share:.0%} of the time"
    )


def _print_verdict(drives: list[Drive]) -> None:
    fastest_m = max(one.driven_m for one in drives)
    lost = [one for one in drives if one.is_lost(fastest_m)]
    if not lost:
        echo("the path is kept at all speeds")
        return
    first = max(lost, key=lambda one: one.speed)
    found = first.blamed
    echo(f"lost from speed {first.speed:g} on, by {found.trigger} of {found.node}")
