# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A matcher on the calling thread."""

from __future__ import annotations

from rmw_manycore_py.native import _ndt
from rmw_manycore_py.ndt.matching.kernel_options import match_options
from rmw_manycore_py.ndt.matching.matcher import Matcher
from rmw_manycore_py.ndt.matching.options import MatcherOptions


class SerialMatcher(Matcher):
    """Matcher on the calling thread."""

    def __init__(self, options: MatcherOptions | None = None) -> None:
        options = options or MatcherOptions()
        super().__init__(options, _ndt.SerialMatcher(match_options(options)))
