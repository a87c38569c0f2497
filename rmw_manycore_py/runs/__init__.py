# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs as other processes find them: directories, logs, sockets (docs/design/control.md)."""
