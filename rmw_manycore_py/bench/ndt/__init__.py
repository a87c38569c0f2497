# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Benchmarks of the scan matcher against published ones."""
