# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Picture of the chip: layout, state, and SVG."""
