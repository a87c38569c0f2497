# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Helpers shared by several groups of verbs."""
