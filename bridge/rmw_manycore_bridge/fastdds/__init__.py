# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""DDS domains as the outside: rclpy on Fast DDS."""
