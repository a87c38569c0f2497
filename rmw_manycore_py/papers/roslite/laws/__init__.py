# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the nodes compute, without ROS. Sources: the nodes of Autoware.AI 1.8."""
