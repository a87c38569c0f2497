# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Interface packages of the user: from definitions to packages that Python imports."""

from __future__ import annotations
