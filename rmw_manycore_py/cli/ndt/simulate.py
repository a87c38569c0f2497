# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore ndt simulate`."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np

from rmw_manycore_py.cli.common.options import examples, number_option
from rmw_manycore_py.cli.common.output_file import writing
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.geometry.poses import transform
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.maps.map_file import write_points
from rmw_manycore_py.ndt.recordings.recording import DEFAULT_SCALE_M, INT16_MAX, save_recording
from rmw_manycore_py.ndt.simulation.drive import (
    Surroundings,
    drive_poses,
    mapping_poses,
    record,
    scans_along,
    sweeps_along,
)
from rmw_manycore_py.ndt.simulation.lidar import Lidar
from rmw_manycore_py.ndt.simulation.street import Street, build_street
from rmw_manycore_py.ndt.simulation.traffic import Traffic
from rmw_manycore_py.process.progress import tracked

MAP_VOXEL_M = 0.2


@click.command(
    "simulate",
    epilog=examples(
        "manycore ndt simulate build/street",
        "manycore ndt simulate build/street --length 300 --speed 10",
        "manycore ndt simulate build/street --beams 128 --azimuths 1800 --range 120",
        "manycore ndt simulate build/street --traffic 6 --occlusion 0.3 --distortion",
    ),
)
@click.argument("directory", type=click.Path(file_okay=False, path_type=Path))
@number_option(
    "--length",
    "length_m",
    within=(5.0, 5000.0),
    default=80.0,
    help="Length of the drive in metres.",
)
@number_option(
    "--speed", "speed_m_s", within=(0.5, 40.0), default=8.0, help="Speed in metres per second."
)
@number_option("--seed", within=(0, None), default=1, help="Seed of the street.")
@number_option("--beams", within=(1, 256), default=Lidar.rings, help="Rings per scan.")
@number_option("--azimuths", within=(36, 8192), default=Lidar.azimuths, help="Points per ring.")
@number_option(
    "--range",
    "range_m",
    within=(5.0, 300.0),
    default=Lidar.range_m,
    help="Range of the LiDAR in metres.",
)
@number_option(
    "--noise",
    "noise_m",
    within=(0.0, 1.0),
    default=Lidar.noise_m,
    help="Standard deviation of the measured ranges, in metres.",
)
@number_option(
    "--traffic",
    "cars",
    within=(0, 20),
    default=0,
    help="Cars driving ahead and behind; not in the map.",
)
@number_option(
    "--occlusion",
    "hidden_share",
    within=(0.0, 0.9),
    default=Lidar.hidden_share,
    help="Fraction of the field of view hidden by the vehicle, at the rear.",
)
@click.option(
    "--distortion",
    is_flag=True,
    help="Move during each scan; drive.npz then holds the time of each point.",
)
def command(
    directory: Path,
    length_m: float,
    speed_m_s: float,
    seed: int,
    cars: int,
    distortion: bool,
    beams: int,
    **lidar: float,
) -> None:
    """Generate a street and a LiDAR drive along it.

    Writes drive.npz and map.npz to DIRECTORY. The map comes from a separate drive without
    traffic, with different positions and noise.
    """
    with writing(directory):
        directory.mkdir(parents=True, exist_ok=True)
    generator = np.random.default_rng(seed)
    street = build_street(length_m, generator)
    sensor = Lidar(rings=beams, **lidar)  # type: ignore[arg-type]
    points = _map_of(street, sensor, length_m, generator)
    with writing(directory / "map.npz"):
        write_points(directory / "map.npz", points)

    poses, stamps = drive_poses(length_m, speed_m_s)
    traffic = Traffic.of(cars, generator) if cars else None
    surroundings = Surroundings(street, sensor, traffic, speed_m_s if distortion else None)
    driven = sweeps_along(surroundings, poses, stamps, generator)
    scans = list(tracked(driven, "drive", len(poses)))
    scale_m = max(DEFAULT_SCALE_M, (sensor.range_m + 10.0 * sensor.noise_m) / INT16_MAX)
    note = f"synthetic street, seed {seed}"
    with writing(directory / "drive.npz"):
        save_recording(directory / "drive.npz", record(scans, poses, stamps, note), scale_m)
    echo(f"{directory / 'map.npz'}: {len(points)} points")
    size = f"about {len(scans[0].points)} points"
    echo(f"{directory / 'drive.npz'}: {len(scans)} scans of {size}")


def _map_of(
    street: Street, lidar: Lidar, length_m: float, generator: np.random.Generator
) -> Points:
    mapped = mapping_poses(length_m)
    scans = scans_along(street, mapped, lidar, generator)
    clouds = [
        transform(pose, scan)
        for pose, scan in zip(mapped, tracked(scans, "map", len(mapped)), strict=True)
    ]
    return voxel_centroids(np.concatenate(clouds), (MAP_VOXEL_M,) * 3)
