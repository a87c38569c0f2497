# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The question how many wrong poses are believed, at a small size and with failing judges."""

from __future__ import annotations

import pytest

from rmw_manycore_py.bench.ndt import trust
from rmw_manycore_py.bench.ndt.trust_cases import Case, cases_of
from rmw_manycore_py.bench.ndt.trust_helpers import Here
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.ndt.trust.judge import PoseJudge, Verdict

pytestmark = [pytest.mark.unit, pytest.mark.long]


@pytest.fixture(scope="module")
def cases() -> dict[str, list[Case]]:
    """Return results of a street and of a repetitive one, each judged with the other's shares."""
    names = ("street 2", "street that repeats every 12 m")
    return {name: cases_of(name, 6, 18) for name in names}


def answered(cases: dict[str, list[Case]], searches: int = 0) -> dict[str, Result]:
    results = trust.judged(cases, 60, searches, Here())
    return {result.question: result for result in results if result.contender == trust.OURS}


def test_no_wrong_pose_is_believed_and_no_right_one_refused(cases):
    results = answered(cases, searches=1)
    assert len(results[trust.BELIEVED].samples) >= 20
    assert len(results[trust.REFUSED].samples) >= 20
    assert results[trust.BELIEVED].summary.largest == 0.0
    assert results[trust.REFUSED].summary.mean <= 3.0
    assert results[trust.FOUND_WRONG].summary.largest == 0.0


def test_a_judge_that_believes_all_is_found_out(cases, monkeypatch):
    def believe_all(*_: object, **__: object) -> Verdict:
        return Verdict("", True, 0.0, None)

    assert any(case.is_wrong for case in cases["street that repeats every 12 m"])
    monkeypatch.setattr(PoseJudge, "judge", believe_all)
    assert answered(cases)[trust.BELIEVED].summary.mean == 100.0


def test_wrong_poses_with_a_wide_covariance_are_let_out_all_the_same(cases, monkeypatch):
    def believe_all(*_: object, **__: object) -> Verdict:
        return Verdict("", False, 0.0, None)

    monkeypatch.setattr(PoseJudge, "judge", believe_all)
    monkeypatch.setattr(Verdict, "covers", lambda *_: True)
    found = answered(cases)
    assert found[trust.BELIEVED].summary.mean == 0.0
    assert found[trust.LET_OUT].summary.mean == 100.0
