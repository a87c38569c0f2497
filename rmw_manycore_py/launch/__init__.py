# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The runner: starts the nodes of a mapfile on their cores and stops them (docs/design/run.md)."""
