# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The mapfile: which node runs on which core of which cluster, and how it is started."""

from rmw_manycore_py.mapfile.loader import Mapfile, load_mapfile

__all__ = ["Mapfile", "load_mapfile"]
