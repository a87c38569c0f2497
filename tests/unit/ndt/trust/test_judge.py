# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Which poses are believed: score, drop and motion separately, and learning from wrong poses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rmw_manycore_py.ndt import Alignment, MatcherOptions
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.trust.judge import WEAK_M, PoseJudge, Verdict
from rmw_manycore_py.ndt.trust.motion import Believed, MotionModel

pytestmark = pytest.mark.unit

OWN_SCORE = 3.0
SPEED_M_S, PERIOD_S = 15.0, 0.1
REFUSED = Alignment.refused(np.eye(4), "", MatcherOptions())


def at(x: float, y: float = 0.0, yaw: float = 0.0) -> np.ndarray:
    return from_xyz_rpy((x, y, 0.0), (0.0, 0.0, yaw))


def aligned(T: np.ndarray, score: float = 3.0, share: float = 1.0) -> Alignment:
    return replace(
        REFUSED,
        T_map_sensor=T,
        nearest_voxel_likelihood=score,
        share_in_map=share,
        is_degenerate=False,
        converged=True,
    )


def driven(scans: int = 30, score: float = 3.0) -> tuple[PoseJudge, float, float]:
    """Return a judge that has seen a drive, and stamp and x of its next scan."""
    judge = PoseJudge()
    judge.level.map_changed(OWN_SCORE)
    for scan in range(scans):
        T = at(scan * PERIOD_S * SPEED_M_S)
        verdict = judge.judge(scan * PERIOD_S, aligned(T, score), T)
        assert verdict.is_believed, verdict.why
        judge.believe(scan * PERIOD_S, aligned(T, score), T)
    return judge, scans * PERIOD_S, scans * PERIOD_S * SPEED_M_S


def test_the_first_poses_are_believed_but_not_sure():
    judge, _, _ = driven(1)
    assert not judge.judge(0.1, aligned(at(1.5)), at(1.5)).is_sure
    judge, stamp_s, x = driven(5)
    assert judge.judge(stamp_s, aligned(at(x)), at(x)).is_sure


def test_a_score_below_the_level_of_map_or_drive_is_refused():
    judge, stamp_s, x = driven()
    assert judge.judge(stamp_s, aligned(at(x), 2.71), at(x)).is_believed
    assert "not above the level 2.700" in judge.judge(stamp_s, aligned(at(x), 2.69), at(x)).why
    fresh = PoseJudge()
    fresh.level.map_changed(OWN_SCORE)
    assert "level" in fresh.judge(0.0, aligned(at(0.0), 1.9), at(0.0)).why


def test_the_level_follows_a_place_of_lower_scores_but_not_below_the_maps():
    judge, stamp_s, x = driven(1)
    score, refused = OWN_SCORE, ""
    while not refused:
        score *= 0.999
        x += SPEED_M_S * PERIOD_S
        refused = judge.judge(stamp_s, aligned(at(x), score), at(x)).why
        if not refused:
            judge.believe(stamp_s, aligned(at(x), score), at(x))
        stamp_s += PERIOD_S
    assert score == pytest.approx(judge.level.of_map, rel=0.002)
    assert judge.level.of_map < 0.9 * OWN_SCORE


def test_a_first_pose_must_fit_well_unless_nothing_can_search():
    for searches, is_believed in ((True, False), (False, True)):
        judge = PoseJudge(searches=searches)
        judge.level.map_changed(OWN_SCORE)
        assert judge.judge(0.0, aligned(at(0.0), 2.9, 0.95), at(0.0)).is_believed
        assert judge.judge(0.0, aligned(at(0.0), 2.9, 0.9), at(0.0)).is_believed == is_believed


def test_only_a_search_may_replace_a_refused_first_pose():
    for searches in (True, False):
        judge = PoseJudge(searches=searches)
        first = judge.judge(0.0, aligned(at(0.0), 0.1), at(0.0))
        assert judge.may_look_again(first) != searches
    judge, stamp_s, x = driven()
    assert judge.may_look_again(judge.judge(stamp_s, aligned(at(x), 0.1), at(x)))


def test_refused_poses_teach_nothing():
    judge, stamp_s, x = driven()
    before = judge.level.level
    for scan in range(1000):
        wrong = aligned(at(x + 20.0), 2.6)
        assert not judge.judge(stamp_s + scan * PERIOD_S, wrong, at(x + 20.0)).is_believed
    assert judge.level.level == before


def test_a_new_map_scales_what_was_learned():
    judge, stamp_s, x = driven()
    judge.level.map_changed(0.5 * OWN_SCORE)
    assert judge.judge(stamp_s, aligned(at(x), 1.36), at(x)).why.startswith("the score fell")
    assert judge.level.level == pytest.approx(0.5 * 0.9 * OWN_SCORE)


def test_the_motion_tells_repeating_streets_apart():
    judge, stamp_s, x = driven()
    period = at(x + 12.0)
    assert "implausible" in judge.judge(stamp_s, aligned(period), period).why
    assert judge.judge(stamp_s, aligned(at(x)), period).is_believed  # recovered from a wrong guess


def test_guesses_carry_over_a_gap_unless_they_jump():
    judge, stamp_s, x = driven()
    later_s, on = stamp_s + 0.9, at(x + SPEED_M_S * 0.9)
    assert judge.judge(later_s, aligned(on), on).is_believed
    assert "implausible" in judge.judge(later_s, aligned(on), at(x)).why
    jumped = at(x + SPEED_M_S * 0.9 + 20.0)
    assert "implausible" in judge.judge(later_s, aligned(jumped), jumped).why


def test_a_hand_that_turns_the_sensor_is_plausible():
    judge = PoseJudge()
    judge.level.map_changed(OWN_SCORE)
    for scan, yaw in enumerate([0.0, 0.0, 0.8, 0.8, 0.0]):
        T = at(0.4 * scan, 0.0, yaw)
        verdict = judge.judge(0.5 * scan, aligned(T), T)
        assert verdict.is_believed, verdict.why
        judge.believe(0.5 * scan, aligned(T), T)


def test_a_sudden_drop_and_points_outside_the_map_are_refused():
    judge, stamp_s, x = driven()
    judge.level.forget()
    assert "fell from" in judge.judge(stamp_s, aligned(at(x), 2.6), at(x)).why
    assert "in the map" in judge.judge(stamp_s, aligned(at(x), 3.0, 0.2), at(x)).why
    assert not judge.judge(stamp_s, REFUSED, at(x)).is_believed


def test_begun_elsewhere_the_judge_knows_no_scores():
    judge, stamp_s, x = driven()
    judge.begin_at(Believed(stamp_s, at(-50.0), at(x)))
    verdict = judge.judge(stamp_s + 0.1, aligned(at(-48.5), 2.6), at(x + 1.5))
    assert verdict.is_believed
    assert not verdict.is_sure
    assert not judge.judge(stamp_s + 0.1, aligned(at(x + 1.5)), at(x + 1.5)).is_believed


def test_the_covariance_is_wide_where_the_pose_is_unknown():
    sure = np.diag([0.02] * 6)
    unsure = Verdict("", False, 0.0, None).covariance(sure)
    assert np.diag(unsure)[:3].min() >= 1.0
    np.testing.assert_array_equal(Verdict("", True, 0.0, None).covariance(sure), sure)
    judge, stamp_s, x = driven()
    tunnel = replace(aligned(at(x)), xy_spread_m2=np.diag([0.4, 0.01]))
    along = judge.judge(stamp_s, tunnel, at(x)).covariance(sure)
    assert along[0, 0] == pytest.approx(WEAK_M**2, rel=0.01)
    assert along[1, 1] == pytest.approx(0.02)


def test_the_motion_leads_along_the_arc_that_a_vehicle_turns_on():
    def on_a_circle(angle: float) -> np.ndarray:
        return at(30.0 * np.sin(angle), 30.0 * (1.0 - np.cos(angle)), angle)

    model = MotionModel()
    for scan in range(2):
        model.believe(scan * PERIOD_S, on_a_circle(0.05 * scan), None)
    expected = model.at(5 * PERIOD_S, None)
    assert expected is not None
    np.testing.assert_allclose(expected.by_motion, on_a_circle(0.25), atol=1e-9)
