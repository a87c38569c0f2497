# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Poses and point clouds between ROS messages and arrays."""
