# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore ndt simulate`."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np
from rich.progress import track

from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.output_file import writing
from rmw_manycore_py.ndt.geometry.poses import transform
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.maps.map_file import write_points
from rmw_manycore_py.ndt.recordings.recording import save_recording
from rmw_manycore_py.ndt.simulation.drive import (
    drive_poses,
    mapping_poses,
    record,
    scans_along,
)
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import build_street

MAP_VOXEL_M = 0.2


@click.command(
    "simulate",
    epilog=examples(
        "manycore ndt simulate build/street",
        "manycore ndt simulate build/street --length 300 --speed 10",
    ),
)
@click.argument("directory", type=click.Path(file_okay=False, path_type=Path))
@click.option(
    "--length",
    "length_m",
    type=click.FloatRange(5.0, 5000.0),
    default=80.0,
    show_default=True,
    help="Metres to drive.",
)
@click.option(
    "--speed",
    "speed_m_s",
    type=click.FloatRange(0.5, 40.0),
    default=8.0,
    show_default=True,
    help="Metres per second.",
)
@click.option("--seed", type=click.IntRange(0), default=1, show_default=True, help="The street.")
def command(directory: Path, length_m: float, speed_m_s: float, seed: int) -> None:
    """Make a street up and drive along it with a LiDAR; write drive.npz and map.npz to DIRECTORY.

    The map comes from a drive of its own, with other positions and other noise.
    """
    with writing(directory):
        directory.mkdir(parents=True, exist_ok=True)
    generator = np.random.default_rng(seed)
    street, lidar = build_street(length_m, generator), Lidar()

    mapped = mapping_poses(length_m)
    clouds = [
        transform(pose, scan)
        for pose, scan in zip(
            mapped,
            track(scans_along(street, mapped, lidar, generator), "map", len(mapped)),
            strict=True,
        )
    ]
    points = voxel_centroids(np.concatenate(clouds), (MAP_VOXEL_M,) * 3)
    with writing(directory / "map.npz"):
        write_points(directory / "map.npz", points)

    poses, stamps = drive_poses(length_m, speed_m_s)
    driven = scans_along(street, poses, lidar, generator)
    scans = list(track(driven, "drive", len(poses)))
    with writing(directory / "drive.npz"):
        save_recording(directory / "drive.npz", record(scans, poses, stamps, seed))
    click.echo(f"{directory / 'map.npz'}: {len(points)} points")
    click.echo(f"{directory / 'drive.npz'}: {len(scans)} scans of about {len(scans[0])} points")
