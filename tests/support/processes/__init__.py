# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Starting real programs, looking at their processes, and limiting what they have."""
