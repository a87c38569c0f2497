# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic record`, with the options of `ros2 bag record`."""

from __future__ import annotations

import re
from pathlib import Path

import click

from rmw_manycore_py.cli.common.completion import complete_message_types, complete_topics
from rmw_manycore_py.cli.common.finite_range import MAX_DEPTH
from rmw_manycore_py.cli.common.options import examples, number_option, platform_option
from rmw_manycore_py.cli.common.seconds import Seconds
from rmw_manycore_py.cli.topic.outside import leave_middleware
from rmw_manycore_py.cli.topic.selection_options import (
    exclude_option,
    exclude_regex_option,
    full_names,
    nothing_chosen,
    regex_option,
)
from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.errors.missing_library import MCAP, require
from rmw_manycore_py.process.virtual_time import lives_in_virtual_time
from rmw_manycore_py.recording.selection import Selection

_MAX_CACHE_BYTES = 100 << 20  # default of rosbag2
# Queue depth of the recorder's subscriptions, for when other processes have the CPU; publishers
# with a larger history raise it.
_DEPTH = 1000


@click.command(
    "record",
    epilog=examples(
        "manycore topic record /chatter /pose",
        "manycore topic record -o drive.mcap '/camera/**' --compression zstd",
        "manycore topic record --all --exclude-topics /rosout",
        "manycore topic record --outside -e '^/lidar' --duration 60",
    ),
)
@click.argument("topics", nargs=-1, shell_complete=complete_topics)
@click.option(
    "-a", "--all", "everything", is_flag=True, help="Record all topics that are not hidden."
)
@regex_option
@click.option(
    "--topic-types",
    "types",
    metavar="TYPE",
    multiple=True,
    shell_complete=complete_message_types,
    help="Record topics of this type; may be repeated.",
)
@exclude_option
@exclude_regex_option
@click.option("--include-hidden-topics", "hidden", is_flag=True, help="Also record hidden topics.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    show_default="rosbag2_<date>-<time>",
    help="File ending in .mcap, or a rosbag2 directory.",
)
@click.option("--force", is_flag=True, help="Overwrite an existing recording.")
@click.option(
    "--duration",
    "duration_s",
    type=Seconds(),
    metavar="S",
    help="Stop after S seconds.",
)
@click.option(
    "--compression",
    type=click.Choice(("none", "lz4", "zstd")),
    default="none",
    show_default=True,
    help="Compression of chunks.",
)
@number_option(
    "--max-cache-size",
    "cache_bytes",
    within=(0, None),
    default=_MAX_CACHE_BYTES,
    metavar="BYTES",
    help="Maximum memory for messages waiting to be written.",
)
@number_option(
    "--depth",
    within=(1, MAX_DEPTH),
    default=_DEPTH,
    metavar="N",
    help="Minimum queue depth per topic.",
)
@click.option("--outside", is_flag=True, help="Record in the DDS domain $ROS_DOMAIN_ID instead.")
@click.option("--json", "as_json", is_flag=True, help="Print what was recorded as JSON.")
@platform_option
def command(
    topics: tuple[str, ...],
    everything: bool,
    regex: re.Pattern[str] | None,
    types: tuple[str, ...],
    excluded: tuple[str, ...],
    exclude_regex: re.Pattern[str] | None,
    hidden: bool,
    output: Path | None,
    force: bool,
    duration_s: float | None,
    compression: str,
    cache_bytes: int,
    depth: int,
    outside: bool,
    as_json: bool,
    platform: str,
) -> None:
    """Record TOPICS in an MCAP file.

    Foxglove, PlotJuggler, `ros2 bag` and `manycore topic play` read it. TOPICS are names or
    patterns: * matches within one part of a name, ** any number of parts. Topics that appear
    later are recorded as well. Stop with Ctrl-C; after a kill, the file is still readable. Lost
    messages are counted.
    """
    if not (topics or everything or regex or types):
        raise nothing_chosen()
    require(MCAP)
    if lives_in_virtual_time():
        raise ManycoreError(
            "the recorder would hold virtual time: start it beside `manycore run`, not as a node",
            EXIT_BAD_INPUT,
        )
    if outside:
        leave_middleware()
    from rmw_manycore_py.cli.topic.recording_session import Settings, record
    from rmw_manycore_py.recording.target import Target, default_target

    selection = Selection(
        names=full_names(topics),
        regex=regex,
        types=types,
        all=everything,
        excluded=full_names(excluded),
        exclude_regex=exclude_regex,
        hidden=hidden,
    )
    target = Target(output or default_target())
    settings = Settings(selection, target, force, duration_s, compression, cache_bytes, depth)
    record(None if outside else platform, settings, as_json=as_json)
