# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs as seen by other processes: directories, logs, sockets (docs/design/control.md)."""
