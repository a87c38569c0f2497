# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Statistics over a window of messages, computed and formatted as `ros2 topic` does."""
