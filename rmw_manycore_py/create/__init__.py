# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore create`: topic table, launch scripts, parameter files, memory report."""

from rmw_manycore_py.create.report import CreateReport
from rmw_manycore_py.create.writer import create

__all__ = ["CreateReport", "create"]
