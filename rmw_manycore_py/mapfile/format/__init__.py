# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Format of a mapfile: from YAML to validated sections."""
