# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Routes of a bridge: which topics and services it joins to the outside."""
