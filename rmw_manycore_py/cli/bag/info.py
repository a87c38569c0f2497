# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore bag info`, with the output format of `ros2 bag info`."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, escaped, print_json, print_notices
from rmw_manycore_py.errors.missing_library import MCAP, require

if TYPE_CHECKING:
    from rmw_manycore_py.recording.recording import Recording

_NS_PER_S = 1_000_000_000
_INDENT = 19
_SERVICE_EVENT = "/_service_event"


@click.command(
    "info",
    epilog=examples("manycore bag info drive.mcap", "manycore bag info rosbag2_2026_05_04"),
)
@click.argument("path", metavar="RECORDING", type=click.Path(exists=True, path_type=Path))
@click.option("-t", "--topic-name", "names_only", is_flag=True, help="Print only the topic names.")
@json_option
def command(path: Path, names_only: bool, as_json: bool) -> None:
    """Show the contents of RECORDING.

    An MCAP file or a rosbag2 directory. Of an unfinished or damaged file, shows what can be
    read, with a notice.
    """
    require(MCAP)
    from rmw_manycore_py.recording.recording import Recording

    with Recording(path) as recording:
        if as_json:
            print_json(_row(recording))
        elif names_only:
            for name in dict.fromkeys(topic.name for topic in recording.topics):
                echo(escaped(name))
        else:
            echo("\n".join(map(escaped, _lines(recording))))
        print_notices([*recording.faults, *recording.remarks])


def _row(recording: Recording) -> dict[str, Any]:
    span = recording.span
    return {
        "files": [str(file) for file in recording.files],
        "size": recording.size_bytes,
        "complete": not recording.faults,
        "ros_distro": recording.distro or None,
        "duration_ns": span.duration_ns,
        "start_ns": span.start_ns,
        "end_ns": span.end_ns,
        "messages": span.messages,
        "topics": [
            {
                "name": row.name,
                "type": row.type,
                "messages": row.messages,
                "encoding": row.encoding,
                "has_definition": bool(row.schema.text),
            }
            for row in recording.topics
        ],
    }


def _lines(recording: Recording) -> list[str]:
    span = recording.span
    topics = [row for row in recording.topics if not row.name.endswith(_SERVICE_EVENT)]
    services = [row for row in recording.topics if row.name.endswith(_SERVICE_EVENT)]
    files = [file.name for file in recording.files]
    found = [
        "",
        *_listed("Files:", files),
        f"Bag size:          {_size(recording.size_bytes)}",
        "Storage id:        mcap",
        f"ROS Distro:        {recording.distro or 'unknown'}",
        f"Duration:          {_seconds(span.duration_ns)}s",
        f"Start:             {_moment(span.start_ns)}",
        f"End:               {_moment(span.end_ns)}",
        f"Messages:          {span.messages - sum(row.messages for row in services)}",
        *_listed(
            "Topic information:",
            [
                f"Topic: {row.name} | Type: {row.type} | Count: {row.messages} | "
                f"Serialization Format: {row.encoding}"
                for row in topics
            ],
        ),
        f"Service:           {len(services)}",
    ]
    events = [
        f"Service: {row.name.removesuffix(_SERVICE_EVENT)} | "
        f"Type: {row.type.removesuffix('_Event')} | Event Count: {row.messages} | "
        f"Serialization Format: {row.encoding}"
        for row in services
    ]
    return [*found, *_listed("Service information:", events, _INDENT + 2)]


def _listed(title: str, values: list[str], indent: int = _INDENT) -> list[str]:
    head, *rest = values or [""]
    return [
        f"{title:{indent}}{head}".rstrip() + " " * (not head),
        *(" " * indent + v for v in rest),
    ]


def _seconds(ns: int) -> str:
    return "{}.{:09}".format(*divmod(ns, _NS_PER_S))


def _moment(ns: int) -> str:
    seconds, rest = divmod(ns, _NS_PER_S)
    local = time.strftime("%b %e %Y %H:%M:%S", time.localtime(seconds))
    return f"{local}.{rest:09} ({_seconds(ns)})"


def _size(size_bytes: int) -> str:
    """Format a size the way rosbag2 does."""
    size, unit = float(size_bytes), 0
    units = ("B", "KiB", "MiB", "GiB", "TiB")
    while size >= 1024 and unit < len(units) - 1:
        size /= 1024
        unit += 1
    return f"{size:.{min(unit, 1)}f} {units[unit]}"
