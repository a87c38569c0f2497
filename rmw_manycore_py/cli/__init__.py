# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The command `manycore`: one package per group of verbs, one file per verb."""

from rmw_manycore_py.cli.main import main

__all__ = ["main"]
