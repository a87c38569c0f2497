# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How pytest runs the tests: one process for each test of the rmw interface."""
