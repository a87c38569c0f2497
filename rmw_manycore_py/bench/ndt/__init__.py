# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the scan matcher costs, beside the published ones."""
