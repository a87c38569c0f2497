# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Whether a pose may be believed, and how to find back when none was."""
