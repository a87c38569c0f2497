# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Matrix products on clusters, as in section 4.2 of Maruyama's thesis."""
