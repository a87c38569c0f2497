# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Recordings, traces and worlds with known content."""
