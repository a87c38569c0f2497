# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The extension modules, the names of their enumerations, and their errors."""
