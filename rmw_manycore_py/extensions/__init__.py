# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Extensions of `ros2 launch` and `ros2`, registered by entry points in pyproject.toml."""
