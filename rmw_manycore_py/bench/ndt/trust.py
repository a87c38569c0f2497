# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How many wrong poses are believed, and how many right ones refused: no drive judged by itself.

The shares that make the score's level are chosen anew for each drive, from all the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rmw_manycore_py.bench.ndt.contenders import on_cpu, usable
from rmw_manycore_py.bench.ndt.trust_cases import Case, cases_of
from rmw_manycore_py.bench.ndt.trust_worlds import drives
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.ndt.trust.score_level import ScoreLevel

CASES = 1000  # right ones, and as many wrong ones
SCANS = 40  # of each drive
BELIEVED, REFUSED = "wrong poses believed", "right poses refused"
AT_START = "wrong poses believed at a start"
SHARES = "share of the drive's median, chosen without the drive"
OURS, AUTOWARE = "rmw_manycore", "as Autoware"
AUTOWARE_SCORE = 2.3  # converged_param_nearest_voxel_transformation_likelihood
# Chosen shares leave 0.3 % of the right poses of other drives below, and some room for a drive that
# is unlike them: scores of a sparse map vary more along the way.
LEFT_BELOW, DRIVE_ROOM, MAP_ROOM = 0.003, 0.02, 0.1


@dataclass(frozen=True)
class Shares:
    """What a level is made of, as :class:`ScoreLevel` takes it."""

    of_map: float
    of_drive: float

    def level(self) -> ScoreLevel:
        """Return a level that has learned nothing yet."""
        return ScoreLevel(self.of_map, self.of_drive)


def measure(run: Run) -> list[Result]:
    """Return shares of results that are judged wrongly."""
    if not run.wants(f"{QUESTION.name}: {OURS}"):
        return []
    share = min(1.0, run.share)
    scans, wanted = max(6, int(SCANS * share)), max(12, int(2 * SCANS * share))
    cases: dict[str, list[Case]] = {}
    with on_cpu(usable()[0]):
        for drive in drives(scans):
            run.note(f"{BELIEVED}: aligning, {drive.name}")
            cases[drive.name] = cases_of(drive, wanted)
    return judged(cases, max(40, int(CASES * share)))


def judged(cases: dict[str, list[Case]], count: int) -> list[Result]:
    """Return the results of at most `count` right and wrong cases, as many of each drive."""
    shares = {
        name: chosen([c for n, all_ in cases.items() if n != name for c in all_]) for name in cases
    }
    right = _picked([[c for c in all_ if c.is_right] for all_ in cases.values()], count)
    wrong = _picked([[c for c in all_ if c.is_wrong] for all_ in cases.values()], count)
    results = [
        _share(BELIEVED, OURS, [misleads(case, shares[case.drive]) for case in wrong]),
        _share(BELIEVED, AUTOWARE, [_as_autoware(case) for case in wrong]),
        _share(REFUSED, OURS, [not _is_believed(case, shares[case.drive]) for case in right]),
        _share(REFUSED, AUTOWARE, [not _as_autoware(case) for case in right]),
        Result(SHARES, OURS, "", tuple(one.of_drive for one in shares.values())),
    ]
    for name in cases:
        of_drive = [case for case in wrong if case.drive == name]
        if of_drive:
            mislead = [misleads(case, shares[name]) for case in of_drive]
            results.append(_share(f"{BELIEVED}: {name}", OURS, mislead))
            fresh = [misleads(replace(case, before=()), shares[name]) for case in of_drive]
            results.append(_share(f"{AT_START}: {name}", OURS, fresh))
        refused = [not _is_believed(c, shares[name]) for c in right if c.drive == name]
        if refused:
            results.append(_share(f"{REFUSED}: {name}", OURS, refused))
    return results


def chosen(cases: Sequence[Case]) -> Shares:
    """Choose the shares by the right poses of some drives."""
    right = [case for case in cases if case.is_right]
    of_map = [case.alignment.nearest_voxel_likelihood / case.own_score for case in right]
    of_drive = [
        case.alignment.nearest_voxel_likelihood / float(np.median([b.score for b in case.before]))
        for case in right
        if case.before
    ]
    return Shares(
        float(np.quantile(of_map, LEFT_BELOW)) - MAP_ROOM,
        float(np.quantile(of_drive, LEFT_BELOW)) - DRIVE_ROOM,
    )


def misleads(case: Case, shares: Shares) -> bool:
    """Tell whether a wrong pose is believed, and its covariance does not say how wrong it is."""
    verdict = case.judged(shares.level())
    if not verdict.is_believed:
        return False
    return not verdict.covers(case.alignment.T_map_sensor, case.truth)


def _is_believed(case: Case, shares: Shares) -> bool:
    return case.judged(shares.level()).is_believed


def _as_autoware(case: Case) -> bool:
    found = case.alignment
    return found.converged and found.nearest_voxel_likelihood > AUTOWARE_SCORE


def _picked(of_drives: Sequence[Sequence[Case]], count: int) -> list[Case]:
    """Return so many cases, the same number of each drive as far as it has them."""
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
    )


QUESTION = Question("trust", measure, _goals(), "on the first usable CPU")
