# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Random mappings of an application."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import yaml

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.mapfile import load_mapfile, resolve
from rmw_manycore_py.platform.topology import usable_cpus

_TRIES = 200  # until the nodes fit into the memory of their clusters


def random_mapping(mapfile: Path, number: int, seed: int, directory: Path) -> Path:
    """Write the mapfile with its nodes on random cores and host CPUs.

    The same number and seed give the same mapping.

    :raises ManycoreError: if no mapping was found that fits.
    """
    path = directory / f"mapping-{number:02}.yaml"
    sections = movable(mapfile)
    draw = random.Random(f"{mapfile.name} {seed} {number}")
    problem: ManycoreError | None = None
    for _ in range(_TRIES):
        _place(sections["nodes"], mapfile, draw)
        path.write_text(yaml.safe_dump(sections, sort_keys=False), encoding="utf-8")
        try:
            resolve(load_mapfile(path))
        except ManycoreError as error:
            problem = error
        else:
            return path
    raise ManycoreError(f"{mapfile}: no random mapping fits: {problem}")


def movable(mapfile: Path) -> dict[str, Any]:
    """Return the sections of a mapfile, with paths that hold in another directory."""
    sections: dict[str, Any] = yaml.safe_load(mapfile.read_text(encoding="utf-8"))
    if "launch_path" in sections:
        sections["launch_path"] = str((mapfile.parent / sections["launch_path"]).resolve())
    return sections


def _place(nodes: dict[str, Any], mapfile: Path, draw: random.Random) -> None:
    clusters = load_mapfile(mapfile).topology.clusters
    free = {one.id: list(one.free) for one in clusters}
    for name, node in nodes.items():
        cluster = draw.choice([number for number, cores in free.items() if cores])
        cores = free[cluster]
        core = cores.pop(draw.randrange(len(cores)))
        place = {"cluster": cluster, "core": core, "host_cpu": draw.choice(usable_cpus())}
        nodes[name] = {**(node or {}), **place}
