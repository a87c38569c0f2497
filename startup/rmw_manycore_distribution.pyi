# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
# Made from cmake/distribution.py.in.
NAME: str
RMW_VERSION: str
RCLPY_VERSION: str
