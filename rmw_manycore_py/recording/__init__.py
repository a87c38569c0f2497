# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Recordings in MCAP files, in the format of rosbag2's storage plugin `mcap`."""
