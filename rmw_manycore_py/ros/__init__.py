# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""ROS 2 conventions: names, domains, and installed packages."""
