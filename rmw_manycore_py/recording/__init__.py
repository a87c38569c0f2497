# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Recorded messages in MCAP files, as rosbag2's storage plugin `mcap` writes them."""
