# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The Autoware reference system's nodes as one rclpy program: see docs/reference_system.md."""
