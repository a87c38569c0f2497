# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""From a mapfile to a placement: resolves all references and assigns cores."""
