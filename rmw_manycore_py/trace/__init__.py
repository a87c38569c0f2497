# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Traces of nodes, receive threads and messages: recorded by the transport, saved, analysed."""
