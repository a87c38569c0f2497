# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What nodes, receive threads and messages did: recorded by the transport, saved, evaluated."""
