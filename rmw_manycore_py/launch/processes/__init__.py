# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One process of a run: program, environment, start, output and end."""
