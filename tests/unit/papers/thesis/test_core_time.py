# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Products on cores of the model: times are those computed by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rmw_manycore_py.papers.thesis.matrix.core_time import product_cycles
from rmw_manycore_py.prediction.bostan.parameters import Parameters

pytestmark = pytest.mark.unit

# A cache line of 16 floats: 10 cycles to the first of its words, 7 for the others.
P = Parameters(multiply_add_cycles=3, cluster_smem_cycles=10, io_smem_cycles=10, line_bytes=64)
LINE_CYCLES = 17


@pytest.mark.parametrize(("threads", "rows"), [(1, 4), (2, 2), (3, 2), (4, 1)])
def test_without_a_cache_each_term_waits_for_two_words(threads: int, rows: int) -> None:
    found = product_cycles((4, 5, 6), "CC SMEM", False, threads, P)
    assert found == rows * 5 * 6 * (3 + 2 * 10)


def test_a_slow_memory_limits_all_threads_together() -> None:
    slow = replace(P, ddr_cycles=30, ddr_bytes_per_s=P.clock_hz)  # a byte per cycle
    # Each of two words occupies a burst of 64 bytes.
    expected = pytest.approx(16 * 5 * 6 * 2 * 64)
    assert product_cycles((16, 5, 6), "IO DDR", False, 4, slow) == expected
    assert product_cycles((16, 5, 6), "IO DDR", False, 16, slow) == expected


def test_a_matrix_that_fits_the_cache_is_loaded_once() -> None:
    # Rows of one line: of each row of C only the row of A is new.
    found = product_cycles((4, 8, 16), "CC SMEM", True, 1, P)
    assert found == pytest.approx(4 * (8 * 16 * 3 + LINE_CYCLES))


def test_a_matrix_that_does_not_fit_is_loaded_for_each_row() -> None:
    # 256 lines pass through the 8 KB of a core, which are 128 lines; the row of A stays.
    found = product_cycles((4, 256, 16), "CC SMEM", True, 1, P)
    assert found == pytest.approx(4 * (256 * 16 * 3 + (256 + 1) * LINE_CYCLES))


def test_io_cores_in_step_share_what_they_load() -> None:
    # 4096 lines pass through their 128 KB, which are 2048 lines, for four rows of C at once.
    found = product_cycles((4, 4096, 16), "IO SMEM", True, 4, P)
    assert found == pytest.approx(4096 * 16 * 3 + (4096 + 4) / 4 * LINE_CYCLES)
