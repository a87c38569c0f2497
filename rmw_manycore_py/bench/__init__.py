# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Benchmarks of rmw_manycore against Fast DDS and the limits of the machine."""
