# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Ordinary rclpy nodes that run on any ROS 2 middleware, without code for rmw_manycore."""
