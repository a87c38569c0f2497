# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Looking at a running platform again and again, without joining it."""
