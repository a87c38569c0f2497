# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Wheels, virtual environments and packages of definitions, as users install them."""
