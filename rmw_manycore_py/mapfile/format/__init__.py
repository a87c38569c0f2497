# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The format of a mapfile: from YAML to sections that are valid in themselves."""
