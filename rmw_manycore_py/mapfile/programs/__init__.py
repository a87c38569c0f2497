# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Programs of nodes: where they are installed, and what their source reveals."""
