# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Points and poses: arrays, transforms, precision, downsampling, filtering."""
