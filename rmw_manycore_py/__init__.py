# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""ROS 2 middleware for clustered many-core processors, on an ordinary Linux host."""

__version__ = "0.1.0"
