# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Advice: which node belongs on which core, by a profile of the application."""
