# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The nodes of the case study that are not part of localization; one per file."""
