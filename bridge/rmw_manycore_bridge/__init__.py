# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bridge between a platform and other domains, for selected topics (docs/design/bridge.md)."""
