# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Predictions beside measurements: of random mappings here, and of others' measurements."""
