# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Texts, commands and imports, read from the sources and the documentation."""
