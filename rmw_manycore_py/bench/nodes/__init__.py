# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""rclpy programs that the benches start, each in a process of its own."""
