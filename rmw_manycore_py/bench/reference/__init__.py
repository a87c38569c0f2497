# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The Autoware reference system: what its 24 nodes take on each middleware."""
