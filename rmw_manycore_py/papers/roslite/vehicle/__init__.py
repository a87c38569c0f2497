# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The outside of the chip: a street, a vehicle with a LiDAR, and what they see of the pipeline."""
