# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Autoware reference system: the cost of its 24 nodes on each middleware."""
