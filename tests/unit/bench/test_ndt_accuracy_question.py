# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The errors of three poses of each scan, from the distances between them."""

from __future__ import annotations

import numpy as np
import pytest

from rmw_manycore_py.bench.ndt.accuracy import own_error_cm

pytestmark = pytest.mark.unit


def test_the_error_of_each_is_told_from_the_others():
    generator = np.random.default_rng(1)
    truth = generator.uniform(-50.0, 50.0, (4000, 3))
    errors_cm = (1.0, 2.0, 3.0)  # root mean squares
    found = [
        truth + generator.normal(scale=0.01 * cm / np.sqrt(3), size=(4000, 3)) for cm in errors_cm
    ]
    found[0][:5] += 3.0  # scans that were not found do not count
    for index, expected_cm in enumerate(errors_cm):
        others = [places for other, places in enumerate(found) if other != index]
        assert own_error_cm(found[index], *others) == pytest.approx(expected_cm, rel=0.1)
