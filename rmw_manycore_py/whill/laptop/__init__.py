# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The laptop: the wheelchair as a plant, its sensors, an operator, and what is measured there."""
