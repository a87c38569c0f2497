# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a mapping shows without a model: what crosses clusters, memory, loads, and a verdict."""

from rmw_manycore_py.mapfile.mapping.facts import Facts, facts_of

__all__ = ["Facts", "facts_of"]
