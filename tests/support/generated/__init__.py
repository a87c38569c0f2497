# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Inputs made at random, each from its number alone."""
