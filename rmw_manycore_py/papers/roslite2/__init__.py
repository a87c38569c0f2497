# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The wheelchair of ROS-lite2's case study: its nodes, and the simulated laptop."""
