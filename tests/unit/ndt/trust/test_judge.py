# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Which poses are believed: score, drop and motion separately, and learning from wrong poses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rmw_manycore_py.ndt import Alignment, MatcherOptions
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy
from rmw_manycore_py.ndt.trust.judge import WEAK_DRIFT, WEAK_M, PoseJudge, Verdict
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


def test_a_pose_still_moving_is_refused_however_well_it_fits():
    judge, stamp_s, x = driven()
    moving = replace(aligned(at(x)), converged=False, why="still moving")
    explained = replace(moving, explained_score=OWN_SCORE)
    for alignment in (moving, explained):
        assert "still moving" in judge.judge(stamp_s, alignment, at(x)).why


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


def test_a_low_score_may_be_explained_also_of_a_first_pose():
    judge = PoseJudge()
    judge.level.map_changed(OWN_SCORE)
    hidden = aligned(at(0.0), 1.8, 0.5)
    assert "level" in judge.judge(0.0, hidden, at(0.0)).why
    for share, is_believed in ((0.92, True), (0.88, False)):
        explained = replace(hidden, explained_score=share * OWN_SCORE)
        assert judge.judge(0.0, explained, at(0.0)).is_believed == is_believed
    judge.begin_at(Believed(0.0, at(0.0), at(0.0)))  # motion confirms the next
    for share, is_believed in ((0.86, True), (0.82, False)):
        explained = replace(aligned(at(1.5), 1.8, 0.5), explained_score=share * OWN_SCORE)
        assert judge.judge(0.1, explained, at(1.5)).is_believed == is_believed
    judge, stamp_s, x = driven()
    explained = replace(aligned(at(x), 1.8), explained_score=0.92 * OWN_SCORE)
    assert judge.judge(stamp_s, explained, at(x)).is_believed
    elsewhere = replace(explained, T_map_sensor=at(x + 12.0))
    assert "implausible" in judge.judge(stamp_s, elsewhere, at(x)).why


def test_traffic_does_not_lower_the_level():
    judge, stamp_s, x = driven()
    before = judge.level.level
    for _ in range(30):
        explained = replace(aligned(at(x), 1.8), explained_score=OWN_SCORE)
        judge.believe(stamp_s, explained, at(x))
        stamp_s, x = stamp_s + PERIOD_S, x + SPEED_M_S * PERIOD_S
    assert judge.level.level == before


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


def test_the_motion_distinguishes_repeating_streets():
    judge, stamp_s, x = driven()
    period = at(x + 12.0)
    assert "implausible" in judge.judge(stamp_s, aligned(period), period).why
    assert judge.judge(stamp_s, aligned(at(x)), period).is_believed  # recovered from a wrong guess


def test_guesses_carry_over_a_gap_unless_they_jump():
    judge, stamp_s, x = driven()
    later_s, on = stamp_s + 0.9, at(x + SPEED_M_S * 0.9)
    assert judge.judge(later_s, aligned(on), on).is_believed
    stayed = judge.judge(later_s, aligned(on), at(x))
    assert stayed.is_believed
    assert not stayed.is_sure
    assert stayed.covariance(np.eye(6))[0, 0] > (0.5 * SPEED_M_S * 0.9) ** 2
    jumped = at(x + SPEED_M_S * 0.9 + 20.0)
    assert "implausible" in judge.judge(later_s, aligned(jumped), jumped).why


@pytest.mark.parametrize("period_s", [0.2, 0.5])
def test_a_hand_that_turns_the_sensor_is_plausible(period_s):
    judge = PoseJudge()
    judge.level.map_changed(OWN_SCORE)
    for scan, yaw in enumerate([0.0, 0.0, 0.9, 0.9, 0.0]):
        T = at(0.4 * scan, 0.0, yaw)
        verdict = judge.judge(period_s * scan, aligned(T), T)
        assert verdict.is_believed, verdict.why
        judge.believe(period_s * scan, aligned(T), T)


def test_a_verdict_knows_whether_only_the_score_is_in_doubt():
    judge, stamp_s, x = driven()
    for score, x_m, is_low, is_plausible in (
        (2.0, x, True, True),
        (2.0, x + 20.0, True, False),
        (3.0, x + 20.0, False, False),
    ):
        verdict = judge.judge(stamp_s, aligned(at(x_m), score), at(x_m))
        assert not verdict.is_believed
        assert (verdict.is_score_low, verdict.is_plausible) == (is_low, is_plausible)
    assert not judge.judge(stamp_s, aligned(at(x), 2.0, 0.1), at(x)).is_score_low


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
    assert along[0, 0] == pytest.approx((WEAK_M + WEAK_DRIFT * 1.5) ** 2, rel=0.01)
    assert along[1, 1] == pytest.approx(0.02)


def test_along_a_tunnel_the_covariance_grows_until_features_return():
    judge, stamp_s, x = driven()
    before_m = 0.0
    for _ in range(100):
        tunnel = replace(aligned(at(x - 0.4)), xy_spread_m2=np.diag([0.4, 0.01]))
        verdict = judge.judge(stamp_s, tunnel, at(x))
        assert verdict.corrected(tunnel.T_map_sensor)[0, 3] == pytest.approx(x)
        assert verdict.along.deviation_m > before_m
        before_m = verdict.along.deviation_m
        judge.believe(stamp_s, replace(tunnel, T_map_sensor=at(x)), at(x))
        stamp_s, x = stamp_s + PERIOD_S, x + SPEED_M_S * PERIOD_S
    assert before_m == pytest.approx(WEAK_M + WEAK_DRIFT * 150.0, rel=0.1)
    out = aligned(at(x - 7.0))
    assert not judge.judge(stamp_s, out, at(x)).is_sure
    assert judge.judge(stamp_s, out, at(x), stood_out=1).along.is_open
    assert judge.judge(stamp_s, out, at(x), stood_out=2).along is None
    judge.believe(stamp_s, out, at(x), stood_out=2)
    on = at(x - 7.0 + SPEED_M_S * PERIOD_S)
    assert judge.judge(stamp_s + PERIOD_S, aligned(on), on).is_sure


def test_guesses_that_turn_around_have_jumped():
    judge, stamp_s, x = driven()
    around = at(x, yaw=np.pi)
    assert judge.judge(stamp_s, aligned(at(x)), around).expected.by_guess is None
    assert "implausible" in judge.judge(stamp_s, aligned(around), around).why
    assert "implausible" in judge.judge(stamp_s + 2.0, aligned(around), around).why


def test_the_motion_leads_along_the_arc_that_a_vehicle_turns_on():
    def on_a_circle(angle: float) -> np.ndarray:
        return at(30.0 * np.sin(angle), 30.0 * (1.0 - np.cos(angle)), angle)

    model = MotionModel()
    for scan in range(2):
        model.believe(scan * PERIOD_S, on_a_circle(0.05 * scan), None)
    expected = model.at(5 * PERIOD_S, None)
    assert expected is not None
    np.testing.assert_allclose(expected.by_motion, on_a_circle(0.25), atol=1e-9)
