# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What `ros2 launch` and `ros2` load of rmw_manycore, by entry points of pyproject.toml."""
