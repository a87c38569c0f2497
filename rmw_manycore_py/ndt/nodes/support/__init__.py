# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What every node needs: declared parameters, start and end, a throttled log."""
