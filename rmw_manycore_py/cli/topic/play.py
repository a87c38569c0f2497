# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic play`, with the options of `ros2 bag play`."""

from __future__ import annotations

import re
from pathlib import Path

import click

from rmw_manycore_py.cli.common.finite_range import MIN_RATE, FiniteRange
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.topic.outside import leave_middleware
from rmw_manycore_py.cli.topic.selection_options import (
    exclude_option,
    exclude_regex_option,
    full_names,
    regex_option,
)
from rmw_manycore_py.errors.missing_library import MCAP, require
from rmw_manycore_py.recording.selection import Selection
from rmw_manycore_py.ros.names import expand

_CLOCK_HZ = 40.0  # as `ros2 bag play --clock`


def _remappings(
    _context: click.Context, _option: click.Parameter, rules: tuple[str, ...]
) -> dict[str, str]:
    found = {}
    for rule in rules:
        old, mark, new = rule.partition(":=")
        if not (mark and old and new):
            raise click.BadParameter(f"expected OLD:=NEW, found '{rule}'.")
        found[expand(old, "/")] = expand(new, "/")
    return found


@click.command(
    "play",
    epilog=examples(
        "manycore topic play drive.mcap",
        "manycore topic play rosbag2_2026_05_04-10_12_30 --rate 2 --loop",
        "manycore topic play drive.mcap --topics /points --remap /points:=/points_raw --clock",
        "manycore topic play drive.mcap --start-offset 10 --duration 5 --start-paused",
    ),
)
@click.argument("path", metavar="RECORDING", type=click.Path(exists=True, path_type=Path))
@click.option(
    "-r",
    "--rate",
    type=FiniteRange(0.01, 1000),
    default=1.0,
    show_default=True,
    help="Playback speed relative to the recording.",
)
@click.option(
    "--topics",
    "names",
    metavar="TOPIC",
    multiple=True,
    help="Play only this topic or pattern; may be repeated.",
)
@regex_option
@exclude_option
@exclude_regex_option
@click.option(
    "-m",
    "--remap",
    "remappings",
    metavar="OLD:=NEW",
    multiple=True,
    callback=_remappings,
    help="Remap a topic; may be repeated.",
)
@click.option("-l", "--loop", is_flag=True, help="Loop at the end.")
@click.option(
    "--clock",
    "clock_hz",
    metavar="[HZ]",
    type=FiniteRange(min=MIN_RATE),
    is_flag=False,
    flag_value=_CLOCK_HZ,
    help=f"Publish /clock, {_CLOCK_HZ:g} times per second by default.",
)
@click.option(
    "-d",
    "--delay",
    "delay_s",
    metavar="S",
    type=FiniteRange(min=0),
    default=0.0,
    help="Wait S seconds before the first message.",
)
@click.option(
    "--start-offset",
    "offset_s",
    metavar="S",
    type=FiniteRange(min=0),
    default=0.0,
    help="Skip the first S seconds of the recording.",
)
@click.option(
    "--duration",
    "--playback-duration",
    "duration_s",
    metavar="S",
    type=FiniteRange(min=0),
    help="Play only S seconds of the recording.",
)
@click.option("-p", "--start-paused", "paused", is_flag=True, help="Start paused.")
@click.option("--disable-keyboard-controls", "keyless", is_flag=True, help="Disable the keys.")
@click.option("--outside", is_flag=True, help="Play in the DDS domain $ROS_DOMAIN_ID instead.")
@click.option("--json", "as_json", is_flag=True, help="Print what was played as JSON.")
@platform_option
def command(
    path: Path,
    rate: float,
    names: tuple[str, ...],
    regex: re.Pattern[str] | None,
    excluded: tuple[str, ...],
    exclude_regex: re.Pattern[str] | None,
    remappings: dict[str, str],
    loop: bool,
    clock_hz: float | None,
    delay_s: float,
    offset_s: float,
    duration_s: float | None,
    paused: bool,
    keyless: bool,
    outside: bool,
    as_json: bool,
    platform: str,
) -> None:
    """Publish the messages of RECORDING as recorded.

    With their recorded timing. RECORDING is an MCAP file, or a rosbag2 directory of such files.
    Topics are published with their recorded QoS. Keys on a terminal: space pauses, right plays
    the next message while paused, up and down change the rate.
    """
    require(MCAP)
    if outside:
        leave_middleware()
    from rmw_manycore_py.cli.topic.playing_session import Settings, play
    from rmw_manycore_py.recording.play.program import Program

    selection = Selection(
        names=full_names(names),
        regex=regex,
        all=not (names or regex),
        excluded=full_names(excluded),
        exclude_regex=exclude_regex,
        hidden=True,
    )
    program = Program(selection, remappings, offset_s, duration_s)
    settings = Settings(path, program, rate, loop, clock_hz, delay_s, paused, keyless)
    play(None if outside else platform, settings, as_json=as_json)
