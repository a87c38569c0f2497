# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore whill drive`."""

from __future__ import annotations

import os
import sys
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import Any

import click

from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.output_file import OutputFile, writing
from rmw_manycore_py.cli.common.printing import echo, new_table, print_json, print_table
from rmw_manycore_py.cli.common.seconds import Seconds
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.processes.environment import OUTSIDE_IMPLEMENTATION, leave_middleware
from rmw_manycore_py.papers.roslite2.course.directory import MAPFILE, read_course
from rmw_manycore_py.papers.roslite2.laptop.drive_log import DriveLog, Summary
from rmw_manycore_py.papers.roslite2.laptop.outcomes import outcomes
from rmw_manycore_py.picture.plotting import load_figure


@click.command(
    "drive",
    epilog=examples(
        "manycore whill drive --course build/whill --run --plot drive.png",
        "manycore whill drive --course build/whill --run --fault ndt_scan_matcher@20",
        "manycore whill drive --course build/whill --run --fault stop:ndt_scan_matcher@20",
        "manycore whill drive --course build/whill --plain --json",
    ),
)
@click.option(
    "--course",
    "course_path",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("build/whill"),
    show_default=True,
    help="Directory written by 'manycore whill course'.",
)
@click.option(
    "--duration",
    "duration_s",
    type=Seconds(),
    metavar="S",
    help="Stop after this many seconds; default: at the end of the course.",
)
@click.option(
    "--timeout",
    "timeout_s",
    type=Seconds(),
    metavar="S",
    default=120.0,
    show_default=True,
    help="Give up if the vehicle has not moved after this many seconds.",
)
@click.option("--run", "runs", is_flag=True, help="Also run the course's mapfile.")
@click.option("--plain", is_flag=True, help="Run the nodes on plain Fast DDS, without a platform.")
@click.option(
    "--netns",
    "namespace",
    metavar="NAME",
    help="With --run or --plain: run the nodes in this network namespace of 'ip netns' (root), "
    "and count its incoming packets.",
)
@click.option(
    "--fault",
    "fault_texts",
    metavar="FAULT",
    multiple=True,
    help="NODE@S: kill -9 after S seconds; stop:NODE@S: SIGSTOP for 2 s; lidar, imu or wheels@S: "
    "stop the sensor. May be repeated.",
)
@click.option(
    "--plot", "picture", type=OutputFile(".png", ".svg", ".pdf"), help="Also draw a plot."
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def command(
    course_path: Path,
    duration_s: float | None,
    timeout_s: float,
    runs: bool,
    plain: bool,
    namespace: str | None,
    fault_texts: tuple[str, ...],
    picture: Path | None,
    as_json: bool,
) -> None:
    """Simulate the laptop of the case study on Fast DDS.

    Wheelchair, sensors and driver. The wheelchair obeys /whill/controller/cmd_vel only. The
    exit status is 0 if it reached the end of the course, or drove for --duration seconds.
    """
    if runs and plain:
        raise click.UsageError("--run and --plain are mutually exclusive")
    if namespace is not None and not (runs or plain):
        raise click.UsageError("--netns is for the nodes that --run or --plain starts")
    if os.environ.get("RMW_IMPLEMENTATION", OUTSIDE_IMPLEMENTATION) != OUTSIDE_IMPLEMENTATION:
        leave_middleware(OUTSIDE_IMPLEMENTATION)
    from rmw_manycore_py.papers.roslite2.laptop.faults import fault_of
    from rmw_manycore_py.papers.roslite2.laptop.progress import DriveProgress
    from rmw_manycore_py.papers.roslite2.laptop.session import DriveOptions, run
    from rmw_manycore_py.papers.roslite2.laptop.stack import PlainStack, PlatformStack, Stack

    if picture is not None:
        load_figure()
    faults = [fault_of(text) for text in fault_texts]
    course = read_course(course_path)
    log = DriveLog(float(course.trajectory.along_m()[-1]))
    options = DriveOptions(course_path, duration_s, timeout_s, faults)
    failure: ManycoreError | None = None
    with ExitStack() as closing:
        stack: Stack | None = None
        if runs or plain:
            mapfile = course_path / MAPFILE
            make = PlatformStack if runs else PlainStack
            stack = make(mapfile, log.tell, namespace)
            closing.callback(stack.close)
        progress = closing.enter_context(DriveProgress())
        try:
            run(course, options, log, stack, progress.report)
        except ManycoreError as error:
            failure = error
    if as_json:
        print_json(_as_data(log))
    elif log.driven():
        _print(log.summary())
        _print_outcomes(log)
    if picture is not None and log.moments:
        from rmw_manycore_py.papers.roslite2.laptop.picture import plot

        with writing(picture):
            plot(log, course, picture)
    if failure is not None:
        raise failure
    sys.exit(0 if log.is_finished or duration_s is not None else 1)


def _as_data(log: DriveLog) -> dict[str, Any]:
    return {
        **asdict(log.summary()),
        "latencies_ms": log.latencies_ms(),
        "periods_ms": log.periods_ms(),
        "incidents": [asdict(one) for one in log.incidents],
        "faults": [asdict(one) for one in outcomes(log)],
    }


def _print_outcomes(log: DriveLog) -> None:
    if not log.injected:
        return
    echo()
    table = new_table("fault", "#told to stand after", "#drives on after", "named")
    for one in outcomes(log):
        times = ("-" if t is None else f"{t:.2f} s" for t in (one.stood_s, one.drove_on_s))
        table.add_row(one.fault, *times, "yes" if one.named_by else "no")
    print_table(table)


def _print(summary: Summary) -> None:
    s = summary
    table = new_table("", "#", "")
    end = "the end of the course" if s.is_finished else f"of {s.course_m:.0f} m"
    rows: list[tuple[str, float | int | None, str]] = [
        ("driven", s.driven_m, f"m, {end}"),
        ("for", s.duration_s, f"s, {s.speed_m_s_mean:.2f} m/s on average"),
        ("lateral error, RMS", s.lateral_m_rms, "m"),
        ("lateral error, largest", s.lateral_m_max, "m"),
        ("scan to command, median", s.latency_ms_median, "ms, at most"),
        ("scan to command, p99", s.latency_ms_p99, "ms, at most"),
        ("command period, median", s.command_period_ms_median, "ms"),
        ("command period, p99", s.command_period_ms_p99, "ms"),
        ("scans", s.scans, f"{s.scans_lost} lost, {s.scans_late} after 100 ms"),
        ("stood on the way", s.stands, "times"),
        ("CPU of the bridge", s.bridge_cpu_percent, "% of one CPU"),
        ("CPU of nodes and bridge", s.platform_cpu_percent, "% of one CPU"),
        ("CPU of the laptop", s.laptop_cpu_s, "s"),
        ("packets to the stack", s.packets_in, "into its network namespace"),
    ]
    for name, value, unit in rows:
        if value is not None:
            table.add_row(name, str(value) if isinstance(value, int) else f"{value:.3f}", unit)
    print_table(table)
