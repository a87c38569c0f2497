# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Statistics of a topic's last messages, computed and written as `ros2 topic` does."""
