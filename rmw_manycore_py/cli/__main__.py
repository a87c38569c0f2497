# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`python -m rmw_manycore_py.cli` is `manycore`."""

from rmw_manycore_py.cli.main import main

main()
