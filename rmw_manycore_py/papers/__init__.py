# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Case studies that reproduce the papers: their nodes, laws, courses, models and benches."""
