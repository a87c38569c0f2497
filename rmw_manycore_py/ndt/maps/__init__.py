# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Point-cloud maps: files, tiles, the area around a vehicle, background building."""
