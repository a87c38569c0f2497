# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore ndt map`."""

from __future__ import annotations

from pathlib import Path

import click

from rmw_manycore_py.cli.common.finite_range import FiniteRange
from rmw_manycore_py.cli.common.options import examples, number_option
from rmw_manycore_py.cli.common.output_file import writing
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.ndt.recording_options import recording_options
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids
from rmw_manycore_py.ndt.maps.map_file import SUFFIXES, write_points
from rmw_manycore_py.ndt.maps.map_tiles import write_tiles
from rmw_manycore_py.ndt.recordings.opening import open_recording


@click.command(
    "map",
    epilog=examples(
        "manycore ndt map drive.npz -o map.pcd",
        "manycore ndt map drive.npz -o map.npz --every 2",
        "manycore ndt map drive.npz -o tiles --tile-size 20",
    ),
)
@click.argument("recording", type=click.Path(exists=True, path_type=Path))
@recording_options
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(path_type=Path),
    help="A .pcd, .ply or .npz file; with --tile-size, a directory to create.",
)
@number_option(
    "--every",
    within=(1, None),
    default=1,
    help="Use every Nth scan only, so that the others are new to the map.",
)
@number_option(
    "--leaf",
    "leaf_m",
    within=(0.0, None),
    default=0.1,
    help="Voxel size in metres, one point per voxel; 0 keeps all points.",
)
@click.option(
    "--tile-size",
    "tile_m",
    type=FiniteRange(1.0),
    help="Tile size in metres: write square tiles and pointcloud_map_metadata.yaml.",
)
@click.option(
    "--format",
    "suffix",
    type=click.Choice([suffix.lstrip(".") for suffix in SUFFIXES]),
    default="pcd",
    show_default=True,
    help="File format of the tiles.",
)
def command(
    recording: Path,
    poses_path: Path | None,
    topic: str,
    pose_topic: str,
    output: Path,
    every: int,
    leaf_m: float,
    tile_m: float | None,
    suffix: str,
) -> None:
    """Build a map from the scans and poses of RECORDING."""
    if not output.parent.is_dir():
        raise click.UsageError(f"--output '{output}': there is no directory '{output.parent}'")
    drive = open_recording(recording, poses_path, topic, pose_topic)
    points = drive.accumulated(range(0, len(drive), every))
    if leaf_m > 0.0:
        points = voxel_centroids(points, (leaf_m,) * 3)
    with writing(output):
        if tile_m is None:
            write_points(output, points)
            echo(f"{output}: {len(points)} points")
        else:
            count = write_tiles(output, points, tile_m, f".{suffix}")
            echo(f"{output}: {len(points)} points in {count} tiles")
