# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A course: trajectory, surroundings and map, and their files."""
