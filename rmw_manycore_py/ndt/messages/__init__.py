# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Conversions of poses and point clouds between ROS messages and arrays."""
