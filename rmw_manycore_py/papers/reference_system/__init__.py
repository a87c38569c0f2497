# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes of the Autoware reference system as one rclpy program (docs/reference/benchmarks)."""
