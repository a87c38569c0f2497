# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Files read by us and by the real reader of their format, and what both make of them."""
