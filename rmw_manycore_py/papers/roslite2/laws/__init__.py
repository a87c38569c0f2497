# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Computations of the nodes as plain functions, without ROS; sources are published nodes."""
