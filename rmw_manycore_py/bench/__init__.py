# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Benches: what rmw_manycore costs, beside the machine itself and beside Fast DDS."""
