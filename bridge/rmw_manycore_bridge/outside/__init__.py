# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the bridge requires of the outside: the interface that each engine implements."""
