# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Rates of wrong poses believed and right ones refused, cross-validated over drives.

The shares that define the score level are chosen for each drive from all others. A process per
usable CPU aligns drives and searches places (trust_helpers.py).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from rmw_manycore_py.bench.ndt.contenders import usable
from rmw_manycore_py.bench.ndt.trust_cases import (
    Case,
    Shares,
    cases_of,
    looked_again,
    moved,
    searched,
)
from rmw_manycore_py.bench.ndt.trust_helpers import Helpers, TrustHelpers
from rmw_manycore_py.bench.ndt.trust_variants import drives
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.matching.second_look import CONVINCING_SHARE
from rmw_manycore_py.ndt.trust.judge import why_unusable
from rmw_manycore_py.ndt.trust.search import Found, Region

CASES = 1000  # of right poses, and of wrong ones
SCANS = 40  # per drive
BELIEVED, REFUSED = "wrong poses believed", "right poses refused"
AT_START = "wrong poses believed at a start"
LET_OUT, LET_OUT_AT_START = "wrong poses let out at all", "wrong poses let out at a start"
REFUSED_AT_START = "right poses refused at a start"
MISSED = "scans with a guess within 1 m and no right pose"
MISSED_AT_START = "first scans with a guess within 1 m and no right pose"
NEVER_FOUND = "first scans with a guess within 1 m whose pose no search finds either"
SHARES = "share of the drive's median, chosen without the drive"
FIRST_SHARES = "share of the map's score for a first pose, chosen without the drive"
EXPLAINED_SHARES = "share of the usual score for an explained score, chosen without the drive"
OURS, AUTOWARE = "rmw_manycore", "as Autoware"
AUTOWARE_SCORE = 2.3  # converged_param_nearest_voxel_transformation_likelihood
SEARCHED, FOUND_WRONG = "right places found by a search", "wrong places found by a search"
FOUND_WRONG_OUTSIDE = "wrong places found by a search that does not reach the scan's"
SEARCHES = 8  # per drive
# The chosen shares leave 0.3 % of the right poses of the other drives below, plus a margin for a
# different drive: scores of a sparse map vary more along the way. A first pose must fit better than
# all wrong ones of the other drives, plus a margin.
LEFT_BELOW, DRIVE_ROOM, MAP_ROOM, FIRST_ROOM = 0.003, 0.07, 0.1, 0.03
# The explained score may leave some above: the best are less than a metre off along a street.
EXPLAINED_ROOM, LEFT_ABOVE = 0.02, 0.001
AROUND_M, GLOBAL_M, OUTSIDE_M = 5.0, 20.0, 30.0
FIRST_SEARCHES = ((GLOBAL_M, True), (AROUND_M, False))  # radius, any yaw


def measure(run: Run) -> list[Result]:
    """Return the shares of results that are misjudged."""
    if not run.wants(QUESTION.name):
        return []
    share = min(1.0, run.share)
    scans, wanted = max(6, int(SCANS * share)), max(12, int(2 * SCANS * share))
    names = list(drives())
    with TrustHelpers(usable()) as helpers:
        run.note(f"{BELIEVED}: aligning scans of {len(names)} drives")
        aligned = helpers.map(lambda name: helpers.call(cases_of, name, scans, wanted), names)
        cases = dict(zip(names, aligned, strict=True))
        run.note(f"{REFUSED}: searching where a start was refused")
        return judged(cases, max(40, int(CASES * share)), SEARCHES, helpers)


def judged(
    cases: dict[str, list[Case]], count: int, searches: int, helpers: Helpers
) -> list[Result]:
    """Return the results of at most `count` right and wrong cases, balanced over drives.

    :param searches: number of searches per drive.
    """
    shares = {
        name: chosen(
            [case for other, of_other in cases.items() if other != name for case in of_other]
        )
        for name in cases
    }
    pools = list(cases.values())
    right = _picked([[case for case in pool if case.is_right] for pool in pools], count)
    wrong = _picked(
        [[case for case in pool if case.is_wrong and _is_judged(case)] for pool in pools], count
    )

    def outcome_of(case: Case) -> Outcome:
        return outcome(case, shares[case.drive], helpers)

    def refused(case: Case) -> bool:
        return is_missed(case, shares[case.drive], helpers, searches=True)

    outcomes = dict(zip(map(id, wrong), helpers.map(outcome_of, wrong), strict=True))
    refuse = dict(zip(map(id, right), helpers.map(refused, right), strict=True))
    starts = [replace(case, before=()) for case in right]
    refuse_at_start = list(helpers.map(refused, starts))
    results = [
        *_missed(
            _picked([[c for c in pool if c.is_near] for pool in pools], count), shares, helpers
        ),
        _share(BELIEVED, OURS, [one.misleads for one in outcomes.values()]),
        _share(LET_OUT, OURS, [one.is_let_out for one in outcomes.values()]),
        _share(BELIEVED, AUTOWARE, [_as_autoware(case) for case in wrong]),
        _share(REFUSED, OURS, list(refuse.values())),
        _share(REFUSED, AUTOWARE, [not _as_autoware(case) for case in right]),
        _share(REFUSED_AT_START, OURS, refuse_at_start),
        Result(SHARES, OURS, "", tuple(one.of_drive for one in shares.values())),
        Result(FIRST_SHARES, OURS, "", tuple(one.of_first for one in shares.values())),
        Result(EXPLAINED_SHARES, OURS, "", tuple(one.of_explained for one in shares.values())),
    ]
    for name in cases:
        of_drive = [case for case in wrong if case.drive == name]
        fresh = list(helpers.map(outcome_of, [replace(case, before=()) for case in of_drive]))
        answers = {
            f"{BELIEVED}: {name}": [outcomes[id(case)].misleads for case in of_drive],
            f"{LET_OUT}: {name}": [outcomes[id(case)].is_let_out for case in of_drive],
            f"{AT_START}: {name}": [one.misleads for one in fresh],
            f"{LET_OUT_AT_START}: {name}": [one.is_let_out for one in fresh],
            f"{REFUSED}: {name}": [refuse[id(case)] for case in right if case.drive == name],
            f"{REFUSED_AT_START}: {name}": [
                is_so
                for case, is_so in zip(right, refuse_at_start, strict=True)
                if case.drive == name
            ],
        }
        results += [_share(question, OURS, is_so) for question, is_so in answers.items() if is_so]
    return [*results, *_searches(wrong, shares, searches, helpers)]


def _missed(near: Sequence[Case], shares: dict[str, Shares], helpers: Helpers) -> list[Result]:
    """Return how many scans with a near guess get no right pose at once, also by drive."""

    def missed(searches: bool, case: Case) -> bool:
        return is_missed(case, shares[case.drive], helpers, searches=searches)

    starts = [replace(case, before=()) for case in near]
    results = []
    for question, cases, searches in (
        (MISSED, near, False),
        (MISSED_AT_START, starts, False),
        (NEVER_FOUND, starts, True),
    ):
        is_so = list(helpers.map(partial(missed, searches), cases))
        results.append(_share(question, OURS, is_so))
        for name in shares:
            of_drive = [one for one, case in zip(is_so, cases, strict=True) if case.drive == name]
            results += [_share(f"{question}: {name}", OURS, of_drive)] if of_drive else []
    return results


def _is_judged(case: Case) -> bool:
    """Return whether a wrong case counts; starts of drives are covered by AT_START."""
    return bool(case.before) or not case.is_drive


def _searches(
    wrong: Sequence[Case], shares: dict[str, Shares], searches: int, helpers: Helpers
) -> list[Result]:
    """Search globally around the guesses of failed alignments."""
    picked = []
    for name in shares:
        picked += [c for c in wrong if c.drive == name and _is_in_reach(c)][:searches]
    if not picked:
        return []
    outside = [
        replace(case, guess=moved(case.truth, OUTSIDE_M, _heading_rad(case) + np.pi * (index % 2)))
        for index, case in enumerate(picked)
        if not case.repeats
    ]
    found = partial(_found_by_search, shares, helpers)
    answers = list(helpers.map(found, picked))
    is_wrong = [clear and not there for clear, there in answers]
    is_right = [clear and there for clear, there in answers]
    is_wrong_outside = [clear and not there for clear, there in helpers.map(found, outside)]
    return [
        _share(SEARCHED, OURS, is_right),
        _share(FOUND_WRONG, OURS, is_wrong),
        _share(FOUND_WRONG_OUTSIDE, OURS, is_wrong_outside),
    ]


def _found_by_search(shares: dict[str, Shares], helpers: Helpers, case: Case) -> tuple[bool, bool]:
    """Return whether a global search finds a unique place, and whether it is the right one."""
    region = Region(case.guess, GLOBAL_M, any_yaw=True)
    found = helpers.call(searched, case.drive, case.index, region)
    is_clear = not found.why_unclear(case.level(shares[case.drive]), region)
    return is_clear, is_clear and _is_there(found, case)


def _heading_rad(case: Case) -> float:
    return float(np.arctan2(case.truth[1, 0], case.truth[0, 0]))


def _is_in_reach(case: Case) -> bool:
    return poses.distance_m(case.guess, case.truth) < GLOBAL_M


def _is_there(found: Found, case: Case) -> bool:
    return replace(case, alignment=found.places[0]).is_right


def chosen(cases: Sequence[Case]) -> Shares:
    """Choose the shares from the right poses of some drives."""
    right = [case for case in cases if case.is_right]
    of_map = [case.score / case.own_score for case in right]
    of_drive = [
        case.score / float(np.median([b.score for b in case.before]))
        for case in right
        if case.before
    ]
    wrong = [
        first
        for first in (replace(case, alignment=case.first) for case in cases if not case.repeats)
        if first.is_wrong and not why_unusable(first.alignment)
    ]
    fits = [case.alignment.fit / case.own_score for case in wrong]
    explained = [case.alignment.explained_score / case.own_score for case in wrong]
    fits = fits or [CONVINCING_SHARE - FIRST_ROOM]
    explained = explained or [CONVINCING_SHARE - EXPLAINED_ROOM]
    return Shares(
        float(np.quantile(of_map, LEFT_BELOW)) - MAP_ROOM,
        float(np.quantile(of_drive, LEFT_BELOW)) - DRIVE_ROOM,
        max(fits) + FIRST_ROOM,
        float(np.quantile(explained, 1.0 - LEFT_ABOVE)) + EXPLAINED_ROOM,
    )


@dataclass(frozen=True)
class Outcome:
    """What becomes of a wrong pose.

    :param is_let_out: it is published, with any covariance.
    :param misleads: it is published with a covariance that does not cover its error.
    """

    is_let_out: bool
    misleads: bool


def outcome(case: Case, shares: Shares, helpers: Helpers) -> Outcome:
    """Return what becomes of a wrong pose.

    If the first look is refused, this is about the pose of the further ones, of which a first pose
    of a drive does not get all. They may find the right pose: that is let out, but not wrong.
    """
    case = helpers.call(looked_again, case, shares)
    verdict = case.judged(shares)
    if not verdict.is_believed:
        return Outcome(False, False)
    covers = verdict.covers(case.alignment.T_map_sensor, case.truth)
    return Outcome(case.is_wrong, not covers)


def is_missed(case: Case, shares: Shares, helpers: Helpers, *, searches: bool) -> bool:
    """Return whether a scan gets no right pose.

    :param searches: a first scan that is refused is searched for.
    """
    case = helpers.call(looked_again, case, shares)
    if case.judged(shares).is_believed:
        return not case.is_right
    other: Found | None = None
    for radius_m, any_yaw in FIRST_SEARCHES if searches and not case.before else ():
        region = Region(case.guess, radius_m, any_yaw)
        found = helpers.call(searched, case.drive, case.index, region)
        if not found.why_unclear(case.level(shares), region, other, is_first=True):
            return not _is_there(found, case)
        other = found
    return True


def _as_autoware(case: Case) -> bool:
    found = case.alignment
    return found.converged and found.nearest_voxel_likelihood > AUTOWARE_SCORE


def _picked(of_drives: Sequence[Sequence[Case]], count: int) -> list[Case]:
    """Return `count` cases, balanced over drives as far as possible."""
    picked: list[Case] = []
    queues = [list(cases) for cases in of_drives]
    while len(picked) < count and any(queues):
        for queue in queues:
            if queue and len(picked) < count:
                picked.append(queue.pop(len(queue) // 2))
    return picked


def _share(question: str, contender: str, is_so: Sequence[bool]) -> Result:
    return Result(question, contender, "%", tuple(100.0 * one for one in is_so))


def _goals() -> tuple[Goal, ...]:
    return (
        Goal(BELIEVED, OURS, "within", 0.0, statistic="mean"),
        Goal(REFUSED, OURS, "within", 1.0, statistic="mean"),
        Goal(MISSED, OURS, "within", 1.0, statistic="mean"),
        Goal(MISSED_AT_START, OURS, "within", 1.0, statistic="mean"),
        Goal(NEVER_FOUND, OURS, "within", 1.0, statistic="mean"),
    )


QUESTION = Question("trust", measure, _goals(), "on all usable CPUs")
