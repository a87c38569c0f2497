# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Shared by all nodes: declared parameters, start and end, a throttled log."""
