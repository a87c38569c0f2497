# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Periodic looks at a running platform, without joining it."""
