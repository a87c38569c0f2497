# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Builds the user's interface packages from definitions, for import in Python."""

from __future__ import annotations
