# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The scan matcher: options, voxel map, serial and worker matchers, their answers."""
