# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The programs that a mapfile names: where they are installed, and what their source says."""
