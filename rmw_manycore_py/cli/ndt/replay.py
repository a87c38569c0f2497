# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore ndt replay`."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import click

from rmw_manycore_py.cli.common.finite_range import FiniteRange, WholeRange
from rmw_manycore_py.cli.common.options import examples, number_option
from rmw_manycore_py.cli.common.printing import echo, new_table, print_json, print_table
from rmw_manycore_py.cli.ndt.recording_options import recording_options
from rmw_manycore_py.cli.ndt.replay_files import ReplayFiles, output_options
from rmw_manycore_py.launch.processes.environment import enter_middleware, leave_middleware
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.geometry.precision import why_coarse
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.maps.map_file import read_points
from rmw_manycore_py.ndt.maps.map_tiles import open_map
from rmw_manycore_py.ndt.recordings.opening import open_recording
from rmw_manycore_py.ndt.recordings.recording import Recording
from rmw_manycore_py.ndt.replay.tally import Summary, Tally, as_json

MAP_VOXEL_M = 0.2
KEPT_SHARE = 0.98  # of the wanted rate: less is reported


@click.command(
    "replay",
    epilog=examples(
        "manycore ndt replay build/street/drive.npz --plot replay.png",
        "manycore ndt replay drive.npz --rate 10 --voxel 0.5",
        "manycore ndt replay drive.npz --guess perturbed --offset 0.5 --turn 3",
        "manycore ndt replay drive.npz --csv scans.csv --tum poses.tum --picture drive.png",
    ),
)
@click.argument("recording", type=click.Path(exists=True, path_type=Path))
@recording_options
@click.option(
    "--map",
    "map_path",
    type=click.Path(exists=True, path_type=Path),
    help="Map to publish; default: map.npz beside RECORDING, else built from every second scan.",
)
@click.option("--no-map", is_flag=True, help="Publish no map; the matcher has its own.")
@click.option(
    "--rate",
    "rate_hz",
    type=FiniteRange(0.1, 1000.0),
    metavar="N",
    help="Scans per second; default: by stamps.",
)
@click.option("--wait", "waits", is_flag=True, help="Wait for each answer before the next scan.")
@click.option(
    "--guess",
    "kind",
    type=click.Choice(["odometry", "velocity", "perturbed", "stack", "lost"]),
    default="odometry",
    show_default=True,
    help="Guesses: closed loop with odometry or constant velocity; perturbed reference; stack: an "
    "initial pose and the speed, for a stack on the platform; or none.",
)
@click.option(
    "--motion",
    type=click.Choice(["scans", "reference"]),
    default="scans",
    show_default=True,
    help="Source of the odometry and of the speed: the scans, matched to each other beforehand, or "
    "the reference poses.",
)
@number_option(
    "--drift", within=(0.0, 1.0), default=0.05, help="Odometry error, as a fraction of each motion."
)
@number_option(
    "--offset", "offset_m", within=(0.0, None), default=0.5, help="Perturbation in metres."
)
@number_option(
    "--turn", "turn_deg", within=(-180.0, 180.0), default=3.0, help="Perturbation in degrees."
)
@number_option("--seed", within=(0, None), default=1, help="Seed of drift and perturbation.")
@number_option(
    "--voxel",
    "voxel_m",
    within=(0.0, None),
    default=0.5,
    help="Voxel size in metres to downsample scans to; 0 sends all points.",
)
@click.option("--scans", type=WholeRange(1), metavar="N", help="Play only the first N scans.")
@number_option(
    "--deadline",
    "deadline_ms",
    within=(0.0, None),
    default=100.0,
    help="Deadline in ms; later answers count as late.",
)
@number_option(
    "--timeout",
    "timeout_s",
    within=(1.0, None),
    default=30.0,
    help="Seconds to wait for the matcher's first answer.",
)
@click.option(
    "--rmw",
    default="rmw_fastrtps_cpp",
    show_default=True,
    help="Middleware to play with; rmw_manycore plays from inside the platform.",
)
@click.option("--json", "as_json_", is_flag=True, help="Print the figures as JSON.")
@click.option(
    "--pid",
    type=WholeRange(1),
    help="Measure the CPU time of this process and its children, not the one reported.",
)
@output_options
def command(
    recording: Path,
    poses_path: Path | None,
    topic: str,
    pose_topic: str,
    map_path: Path | None,
    no_map: bool,
    rate_hz: float | None,
    waits: bool,
    kind: str,
    motion: str,
    drift: float,
    offset_m: float,
    turn_deg: float,
    seed: int,
    voxel_m: float,
    scans: int | None,
    deadline_ms: float,
    timeout_s: float,
    rmw: str,
    as_json_: bool,
    pid: int | None,
    **files: Path | None,
) -> None:
    """Play RECORDING to a scan matcher.

    As the stack of a laptop outside the platform does. Publishes pointcloud_map,
    ekf_pose_with_covariance and points_raw, subscribes to ndt_pose, and reports error, latency
    and losses. The exit status is 1 if a scan was lost, late or diverged.
    """
    outputs = ReplayFiles(**files)
    outputs.check()
    _enter(rmw)
    from rmw_manycore_py.ndt.replay.guess_kinds import GuessKind
    from rmw_manycore_py.ndt.replay.session import run

    drive = open_recording(recording, poses_path, topic, pose_topic).first(scans)
    if drive.note:
        echo(f"recording: {drive.note}", err=True)
    guesses = GuessKind(kind, motion, drift, offset_m, turn_deg, seed)
    motions = guesses.motions(drive)
    made_of = guesses.made_of(motions)
    echo(f"guesses: {made_of}", err=True)
    source = guesses.source(drive, motions, rate_hz)
    points = None if no_map else _map_of(recording, drive, map_path)
    if points is not None and (warning := why_coarse(points)):
        echo(f"the map is coarse: {warning}", err=True)
    tally = Tally(deadline_ms)
    run(drive, source, tally, points, voxel_m, rate_hz, waits, timeout_s, pid)
    summary = tally.summary()
    if complaint := tally.complaint():
        echo(f"the matcher reported of the first lost scan: {complaint}", err=True)
    print_json({"guesses": made_of, **as_json(summary)}) if as_json_ else _print(
        summary, deadline_ms
    )
    outputs.write(tally, drive, points)  # last, so that a full disk does not lose the figures
    sys.exit(0 if summary.is_good else 1)


def _enter(rmw: str) -> None:
    if rmw == "rmw_manycore":
        enter_middleware()
    elif os.environ.get("RMW_IMPLEMENTATION", "rmw_fastrtps_cpp") != rmw:
        leave_middleware(rmw)


def _map_of(recording: Path, drive: Recording, map_path: Path | None) -> Points:
    """Return the points (N, 3) of the map to publish, in the map frame, metres."""
    beside = recording.resolve().with_name("map.npz")
    if map_path is None and beside.exists() and beside != recording.resolve():
        map_path = beside
    if map_path is None:
        return voxel_centroids(drive.accumulated(range(0, len(drive), 2)), (MAP_VOXEL_M,) * 3)
    if map_path.is_dir():
        return open_map(map_path).around(0.0, 0.0, float("inf"))[1]
    return read_points(map_path)


def _pace(s: Summary) -> str:
    """Return the rate at which scans were sent, and by how much that is not the wanted one."""
    if s.wanted_hz is None:
        return f"sent {s.rate_hz:.1f} scans a second, each after the answer to the last one"
    kept = f"sent {s.rate_hz:.1f} scans a second"
    is_slow = s.rate_hz < KEPT_SHARE * s.wanted_hz
    return f"{kept}, {s.wanted_hz:.1f} were due: this machine is too slow" if is_slow else kept


def _print(summary: Summary, deadline_ms: float) -> None:
    s = summary
    table = new_table("", "#median", "#p99", "#max")
    rows = [
        ("error, m", s.error_m_median, s.error_m_p99, s.error_m_max),
        ("error, degrees", s.error_deg_median, None, s.error_deg_max),
        ("latency, ms", s.latency_ms_median, s.latency_ms_p99, s.latency_ms_max),
        ("guess error, m", None, None, s.guess_error_m_max),
        ("guess error, degrees", None, None, s.guess_error_deg_max),
    ]
    for name, *values in rows:
        if all(value is None or value != value for value in values):
            continue  # no scan was answered, or guesses were not made here
        table.add_row(name, *("" if value is None else f"{value:.3f}" for value in values))
    print_table(table)
    echo(_pace(s))
    cpu = "" if s.node_cpu_percent is None else f"; matcher's CPU: {s.node_cpu_percent:.1f} %"
    echo(
        f"{s.scans} scans: {s.answered} answered, {s.lost} lost, {s.late} after {deadline_ms:g} "
        f"ms, {s.diverged} diverged; {100 * s.within_share:.1f} % within 0.2 m and 1 degree{cpu}"
    )
