# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Helpers around rclpy, and nodes that several suites start."""
