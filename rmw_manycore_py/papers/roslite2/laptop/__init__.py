# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The simulated laptop: plant, sensors, operator and observer."""
