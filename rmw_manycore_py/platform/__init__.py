# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A platform as seen from outside: what runs, on which clusters, and what it holds."""
