# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The mapfile that ROS-lite2's own create.py reads (Fig. 8)."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from rmw_manycore_py.mapfile.format.mapfile import Mapfile
from rmw_manycore_py.mapfile.placing.placement import PlacedNode


def papers_mapfile(
    mapfile: Mapfile, nodes: Sequence[PlacedNode], parameter_files: Mapping[str, Sequence[str]]
) -> dict[str, Any]:
    """Return the mapfile with the keys of Fig. 8 alone.

    What create.py does not know is left out: programs without a launch file, services and actions
    outside, memory of topics, settings of processes.

    :param parameter_files: of each node, by its name, in rcl's order; Fig. 8 has one.
    """
    launch = mapfile.sections.launch_path
    placed = {
        node.name: {
            "cluster": node.cluster,
            "core": node.core,
            "topic_in": _topics(mapfile, node, "topic_in"),
            "topic_to": _topics(mapfile, node, "topic_to"),
            "param_file": _one_or_more(parameter_files[node.name]),
        }
        for node in nodes
    }
    path = {"launch_path": os.fspath(mapfile.file(launch))} if launch else {}
    return {"nodes": placed, **path}


def _topics(mapfile: Mapfile, node: PlacedNode, key: str) -> dict[str, str | None]:
    section = mapfile.sections.nodes[node.name]
    return dict(getattr(section, key)) or {"none": None}


def _one_or_more(files: Sequence[str]) -> str | list[str] | dict[str, None]:
    if len(files) > 1:
        return list(files)
    return files[0] if files else {"none": None}
