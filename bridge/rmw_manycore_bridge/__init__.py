# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The bridge between a platform and DDS domains, for chosen topics (docs/design/bridge.md)."""
