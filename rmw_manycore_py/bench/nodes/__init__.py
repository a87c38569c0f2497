# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""rclpy programs started by the benches, one process each."""
