# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The pose that a killed process leaves for its successor."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.trust.last_pose import LastPose
from rmw_manycore_py.ndt.trust.motion import Believed

pytestmark = pytest.mark.unit

T, GUESS = from_xyz_rpy((1.0, 2.0, 3.0), (0.0, 0.1, 2.0)), from_xyz_rpy((1.5, 2.0, 3.0))


@pytest.mark.parametrize("guess", [GUESS, None], ids=["guess", "no guess"])
def test_a_pose_outlives_its_process(tmp_path: Path, guess: np.ndarray | None) -> None:
    LastPose(tmp_path / "pose").write(50.0, Believed(100.0, T, guess), is_activated=True)
    left = LastPose(tmp_path / "pose").read(51.0, max_age_s=60.0)
    assert left is not None
    believed, is_activated = left
    assert is_activated
    assert believed.stamp_s == 100.0
    np.testing.assert_allclose(believed.T, T, atol=1e-12)
    if guess is None:
        assert believed.guess is None
    else:
        np.testing.assert_allclose(believed.guess, guess, atol=1e-12)


def test_what_is_no_pose_of_now_is_passed_over(tmp_path: Path) -> None:
    path = tmp_path / "pose"
    last = LastPose(path)
    assert last.read(100.0, 60.0) is None
    last.write(50.0, Believed(100.0, T, None), is_activated=False)
    assert last.read(111.0, 60.0) is None
    assert last.read(49.0, 60.0) is None
    data = bytearray(path.read_bytes())
    data[60] ^= 1
    path.write_bytes(data)
    assert LastPose(path).read(51.0, 60.0) is None
    last.write(50.0, Believed(100.0, T, None), is_activated=False)
    assert last.read(51.0, 60.0) is not None
    last.forget()
    assert last.read(51.0, 60.0) is None


def test_a_file_that_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(ManycoreError, match="last_pose_path"):
        LastPose(tmp_path)
