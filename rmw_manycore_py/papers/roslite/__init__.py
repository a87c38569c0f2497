# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The self-driving pipeline of ROS-lite (III-C): planning, following, and a split localizer."""
