# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Types used by the nodes of a mapfile, installed or not."""

from __future__ import annotations

from rmw_manycore_py.mapfile.format.mapfile import Mapfile
from rmw_manycore_py.mapfile.placing.crossings import CROSSINGS
from rmw_manycore_py.mapfile.placing.launched import read_launch
from rmw_manycore_py.mapfile.placing.start import node_starts


def used_types(mapfile: Mapfile) -> set[str]:
    """Return the types named in the mapfile and imported by the sources of its nodes."""
    sections = mapfile.sections
    found = {topic.type for topic in sections.topics.values()}
    for node in sections.nodes.values():
        for key in ("publish", "subscribe", *CROSSINGS):
            found.update(getattr(node, key).values())
    starts = node_starts(mapfile, read_launch(mapfile), is_plan=sections.plan)
    for start in starts.values():
        if start.source is not None:
            found.update(start.source.interfaces)
    return {name for name in found if name is not None}
