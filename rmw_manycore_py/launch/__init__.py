# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The runner: starts and stops the nodes of a mapfile on their cores (docs/design/run.md)."""
