# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Profiles: what an application does, apart from where it runs."""
