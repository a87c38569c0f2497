# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""An advised mapping beside random ones, all of them measured."""
