# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A map as a directory of tiles, of which those around a position are loaded.

With Autoware's `pointcloud_map_metadata.yaml` (tile size, and the lower corner of each file) in the
directory, tiles are opened on demand; otherwise all are read once for their extent.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import yaml

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.errors.yaml_faults import yaml_fault
from rmw_manycore_py.ndt.files.cloud_file import suffix_of
from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.maps.map_file import SUFFIXES, read_points, write_points

METADATA = "pointcloud_map_metadata.yaml"


@dataclass(frozen=True)
class Tile:
    """A file and its extent in x and y, in metres in the map frame."""

    path: Path
    lower: tuple[float, float]
    upper: tuple[float, float]

    @property
    def is_everywhere(self) -> bool:
        """Return whether the extent is unlimited, as for a map of one file."""
        return not np.isfinite(self.lower).all()

    def is_within(self, x: float, y: float, radius_m: float) -> bool:
        """Return whether the extent intersects a circle."""
        dx = max(self.lower[0] - x, 0.0, x - self.upper[0])
        dy = max(self.lower[1] - y, 0.0, y - self.upper[1])
        return dx * dx + dy * dy <= radius_m * radius_m


@dataclass(frozen=True)
class TileFiles:
    """Tiles to read, in this process or in another.

    :param leaf_m: voxel size for thinning; 0 keeps all points.
    """

    paths: tuple[Path, ...]
    leaf_m: float

    def read(self, loaded: dict[Path, Points]) -> Points:
        """Return the points (N, 3) of all tiles; raises ManycoreError.

        :param loaded: points of tiles read before, which are not read again; updated to the points
            of these tiles.
        """
        read = {
            path: loaded[path] if path in loaded else read_points(path, self.leaf_m)
            for path in self.paths
        }
        loaded.clear()
        loaded.update(read)
        clouds = list(read.values())
        return np.concatenate(clouds) if clouds else np.zeros((0, 3), np.float32)


@dataclass
class TiledMap:
    """Tiles of a map; caches the points returned last."""

    tiles: tuple[Tile, ...]
    leaf_m: float = 0.0
    _loaded: dict[Path, Points] = field(default_factory=dict)

    def around(self, x: float, y: float, radius_m: float) -> tuple[frozenset[Path], Points]:
        """Return the files within a radius of a position, and their points (N, 3)."""
        files = self.files_around(x, y, radius_m)
        return frozenset(files.paths), self.read(files)

    def files_around(self, x: float, y: float, radius_m: float) -> TileFiles:
        """Return the files within a radius of a position, without loading them."""
        near = [tile.path for tile in self.tiles if tile.is_within(x, y, radius_m)]
        return TileFiles(tuple(near), self.leaf_m)

    def read(self, files: TileFiles) -> Points:
        """Return the points (N, 3) of files, those that are loaded already from memory."""
        return files.read(self._loaded)

    def let_go(self) -> None:
        """Drop the loaded points; they are read again when needed."""
        self._loaded.clear()

    def tile_points(self, tile: Tile) -> Points:
        """Return the points (N, 3) of one tile, cached or read; raises ManycoreError."""
        return self._points_of(tile.path)

    def _points_of(self, path: Path) -> Points:
        loaded = self._loaded.get(path)
        return read_points(path, self.leaf_m) if loaded is None else loaded


def open_map(path: Path, leaf_m: float = 0.0, metadata: Path | None = None) -> TiledMap:
    """Return a map that is one file (a single unlimited tile) or a directory of tiles.

    :param metadata: the list of tiles; default: the one in the directory.
    :raises ManycoreError: for a path that is no map or cannot be read.
    """
    try:
        return _opened(path, leaf_m, metadata)
    except OSError as error:
        raise ManycoreError(f"map {path}: {error.strerror}", EXIT_BAD_INPUT) from error


def _opened(path: Path, leaf_m: float, metadata: Path | None) -> TiledMap:
    if not path.is_dir():
        points = read_points(path, leaf_m)
        everywhere = Tile(path, (-np.inf, -np.inf), (np.inf, np.inf))
        return TiledMap((everywhere,), leaf_m, {path: points})
    listed = metadata or path / METADATA
    tiles = _listed(listed, path) if metadata or listed.exists() else _measured(path)
    if not tiles:
        raise ManycoreError(f"map {path}: the folder has no PCD, PLY or npz file", EXIT_BAD_INPUT)
    return TiledMap(tuple(tiles), leaf_m)


def write_tiles(folder: Path, points: Points, size_m: float, suffix: str) -> int:
    """Write points as square tiles with Autoware's metadata; return the number of tiles."""
    folder.mkdir(exist_ok=True)
    cells = np.floor(points[:, :2] / size_m).astype(int)
    table: dict[str, object] = {"x_resolution": size_m, "y_resolution": size_m}
    corners = np.unique(cells, axis=0)
    for column, row in corners:
        name = f"{column}_{row}{suffix}"
        write_points(folder / name, points[(cells == (column, row)).all(axis=1)])
        table[name] = [float(column * size_m), float(row * size_m)]
    (folder / METADATA).write_text(yaml.safe_dump(table, sort_keys=False))
    return len(corners)


def _listed(metadata: Path, folder: Path) -> list[Tile]:
    try:
        table = yaml.safe_load(metadata.read_text())
        size_x, size_y = float(table.pop("x_resolution")), float(table.pop("y_resolution"))
        corners = {name: (float(x), float(y)) for name, (x, y) in table.items()}
    except (yaml.YAMLError, AttributeError, KeyError, TypeError, ValueError) as error:
        raise ManycoreError(
            f"{metadata}: expected x_resolution, y_resolution and FILE: [x, y] for each tile, "
            f"found {yaml_fault(error)}",
            EXIT_BAD_INPUT,
        ) from error
    tiles = [
        Tile(folder / name, (x, y), (x + size_x, y + size_y)) for name, (x, y) in corners.items()
    ]
    for tile in tiles:
        if not tile.path.is_file():
            raise ManycoreError(f"{metadata}: the tile {tile.path.name} is missing", EXIT_BAD_INPUT)
    return tiles


def _measured(folder: Path) -> list[Tile]:
    tiles = []
    for path in sorted(path for path in folder.iterdir() if suffix_of(path) in SUFFIXES):
        points = read_points(path)
        (x0, y0), (x1, y1) = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
        tiles.append(Tile(path, (float(x0), float(y0)), (float(x1), float(y1))))
    return tiles
