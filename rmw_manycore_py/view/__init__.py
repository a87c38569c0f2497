# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The chip in the browser: a local web server for one user."""
