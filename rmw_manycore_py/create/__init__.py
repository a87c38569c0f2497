# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What `manycore create` writes: topic table, launch scripts, parameter files, memory."""
