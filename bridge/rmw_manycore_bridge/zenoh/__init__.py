# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Zenoh as the outside: peers of rmw_zenoh, without rclpy (docs/how-to/rmw_zenoh.md)."""
