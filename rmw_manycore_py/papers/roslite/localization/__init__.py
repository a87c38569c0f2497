# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Scan matching in parts: a map in tiles, radius search, derivatives."""
