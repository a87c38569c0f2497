# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A course to drive: trajectory, surroundings and map, and the files they are kept in."""
