# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What ROS 2 prescribes: names, domains, and where packages are installed."""
