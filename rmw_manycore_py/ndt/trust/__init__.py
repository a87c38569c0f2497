# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Whether a pose is believed, and recovery after refused poses."""
