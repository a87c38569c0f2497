# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A mapfile as it was read."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py.mapfile.format.document import Document
from rmw_manycore_py.mapfile.format.model import MapfileSections
from rmw_manycore_py.topology import Topology


@dataclass(frozen=True)
class Mapfile:
    """A mapfile that is valid in itself; whether its executables exist is `resolve`'s business."""

    path: Path
    sections: MapfileSections
    topology: Topology
    document: Document
    notices: tuple[str, ...]

    def file(self, name: str) -> Path:
        """Return a file the mapfile names: relative to the mapfile, `~` expanded."""
        return Path(os.path.realpath(self.path.parent / os.path.expanduser(name)))
