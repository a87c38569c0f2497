# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The machine itself: its CPUs as the kernel shows them, and the clusters that they form."""
