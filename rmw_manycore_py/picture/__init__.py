# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The picture of the chip: where everything lies, what it looks like, and its SVG."""
