# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Ordinary rclpy nodes: they know nothing of rmw_manycore and run on any ROS 2 middleware."""
