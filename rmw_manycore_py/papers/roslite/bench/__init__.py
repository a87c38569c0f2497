# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The evaluations of ROS-lite (IV-A): Fig. 13 to 16 and Table I, on its pipeline."""
