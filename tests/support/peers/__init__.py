# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Peers: functions of test files that run in processes of their own, forked by a server."""
