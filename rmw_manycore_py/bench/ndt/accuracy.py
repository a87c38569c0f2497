# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the error of a pose is made of: the matcher's own, the guess's rest, the reference's.

The reference poses of a recording have errors of their own. Of three poses of one scan whose errors
are independent, the distances between them yield the error of each: with d_ab^2 the mean square of
the distance between a and b, the mean square error of a is (d_ab^2 + d_ac^2 - d_bc^2) / 2. They are
the reference, our pose in a map of every fourth scan, and that of ICP in a map of other scans.
References are also refined (refined.py): the surfaces of points that were not aligned show whether
that was an improvement. Streets have exact poses.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from rmw_manycore_py.bench.ndt.basin import (
    ERROR_DEG,
    ERROR_M,
    HOME_M,
    ICP,
    STREETS,
    Place,
    contender,
    outcome,
    place_of,
    recorded_drive,
    street,
)
from rmw_manycore_py.bench.ndt.contenders import VOXEL_SIZE_M, on_cpu, usable
from rmw_manycore_py.bench.ndt.refined import Halves, cloud, refined_poses, thicknesses_cm
from rmw_manycore_py.bench.ndt.world import recorded, world_of
from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.summary import Goal, Result
from rmw_manycore_py.ndt import MatcherOptions
from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.geometry.thinning import voxel_centroids

SCANS, SCANS_OF_STREET = 88, 30
SEED = 5
OWN = "rmw_manycore"
OPTIONS = {
    OWN: MatcherOptions(voxel_size_m=VOXEL_SIZE_M, search="radius"),
    f"{OWN}, steps to 0.1 mm": MatcherOptions(
        voxel_size_m=VOXEL_SIZE_M, search="radius", trans_epsilon=1e-4, max_iterations=100
    ),
    f"{OWN}, not polished": MatcherOptions(
        voxel_size_m=VOXEL_SIZE_M, polish_levels=(), search="radius"
    ),
    f"{OWN}, 1 m last": MatcherOptions(
        voxel_size_m=1.0,
        coarse_levels=(4.0, 2.0),
        wide_levels=(8.0,),
        polish_levels=(),
        search="radius",
    ),
}
OFF_REFERENCE = "off the reference pose"
OFF_ICP = f"off {ICP}"
OFF_ITSELF = "off itself from another guess"
OF_THREE = "error by three poses, in maps of different scans"
OFF_EXACT = "off the exact pose, streets"
THINNED_M = 0.25  # edge of a filter's voxels, each of which leaves one point
OFF_EXACT_THINNED = f"{OFF_EXACT}, scans of {THINNED_M:g} m"
CPU_THINNED = f"CPU time of a scan of {THINNED_M:g} m, streets"
OFF_REFINED = "off the refined reference pose"
SURFACES = "thickness of surfaces of points that were not aligned"
REFERENCE, REFINED = "reference poses", "refined reference poses"
JUDGED = (OFF_EXACT, OFF_REFERENCE, OFF_REFINED)
STEP = 4  # between the scans of a map, so that two maps share none
CM = 100.0


def measure(run: Run) -> list[Result]:
    """Return errors of positions in cm, from guesses that are 2 m and 10 degrees off."""
    if not run.wants(QUESTION.name):
        return []
    with on_cpu(usable()[0]):
        run.note(f"{QUESTION.name}: recorded scans")
        scans = run.iterations(SCANS)
        results = [*_of_recording(recorded_drive(scans)), *_of_three(scans)]
        run.note(f"{QUESTION.name}: refined references")
        results += _of_refined(scans)
        for name in STREETS:
            run.note(f"{QUESTION.name}: {name}")
            place = street(name, run.iterations(SCANS_OF_STREET))
            results += [*_of_street(place), *_of_thinned(place)]
    return _joined(results)


def _found(place: Place, seed: int, names: Sequence[str] = (*OPTIONS, ICP)) -> dict[str, Matrix]:
    """Return where each contender finds the scans (S, 3)."""
    found = {}
    for name in names:
        align = contender(name, place, OPTIONS)
        if align is None:
            continue
        generator = np.random.default_rng(seed)
        results = []
        for scan, truth in zip(place.scans, place.truths, strict=True):
            guess = poses.perturbed(truth, ERROR_M, float(np.radians(ERROR_DEG)), generator)
            results.append(align(scan, guess))
        found[name] = _places(results)
    return found


def _of_recording(drive: Place) -> list[Result]:
    first, second = _found(drive, SEED), _found(drive, SEED + 1)
    reference = _places(drive.truths)
    results = []
    for name, found in first.items():
        results.append(_result(OFF_REFERENCE, name, _apart_cm(found, reference)))
        results.append(_result(OFF_ITSELF, name, _apart_cm(found, second[name])))
        if ICP in first and name != ICP:
            results.append(_result(OFF_ICP, name, _apart_cm(found, first[ICP])))
    return results


def _of_street(place: Place) -> Iterator[Result]:
    exact = _places(place.truths)
    for name, places in _found(place, SEED).items():
        yield _result(OFF_EXACT, name, _apart_cm(places, exact))


def _of_thinned(place: Place) -> Iterator[Result]:
    """Yield errors and CPU times of scans that a voxel filter has thinned."""
    scans = [voxel_centroids(scan, (THINNED_M,) * 3) for scan in place.scans]
    thinned = replace(place, scans=scans)
    for name in (OWN, ICP):
        align = contender(name, thinned, OPTIONS)
        if align is not None:
            one = outcome(align, thinned, (ERROR_M, ERROR_DEG))
            yield _result(OFF_EXACT_THINNED, name, [CM * error_m for error_m in one.error_m])
            yield Result(CPU_THINNED, name, "ms", one.cpu_ms)


def _of_three(scans: int) -> list[Result]:
    """Return the errors of our poses, of those of ICP and of the references."""
    drive, beside = (recorded_drive(scans, first, STEP) for first in (0, STEP // 2))
    own, icp = _found(drive, SEED, [OWN]), _found(beside, SEED, [ICP])
    if not icp:
        return []
    found = {OWN: own[OWN], ICP: icp[ICP], REFERENCE: _places(drive.truths)}
    results = []
    for name in found:
        others = [places for other, places in found.items() if other != name]
        results.append(_result(OF_THREE, name, [own_error_cm(found[name], others[0], others[1])]))
    return results


def _of_refined(scans: int) -> list[Result]:
    """Return errors to better references, in a map of theirs, and how much better these are."""
    recording, name = recorded()
    halves = Halves.of(recording)
    T = refined_poses(halves.aligned, recording.poses)
    results = [
        _result(SURFACES, of, [float(cm) for cm in thicknesses_cm(cloud(halves.judging, given))])
        for of, given in ((REFERENCE, recording.poses), (REFINED, T))
    ]
    drive = place_of(world_of(replace(recording, poses=T), name, scans))
    truths = _places(drive.truths)
    for own, found in _found(drive, SEED).items():
        results.append(_result(OFF_REFINED, own, _apart_cm(found, truths)))
    return results


def own_error_cm(own: Matrix, second: Matrix, third: Matrix) -> float:
    """Return the root mean square error of one of three whose errors are independent.

    Each of the places (S, 3), m. Scans that one of them did not find are left out.
    """
    pairs = [(own, second), (own, third), (second, third)]
    squares = np.array([np.square(_apart_cm(a, b)) for a, b in pairs])
    squares = squares[:, (squares < (CM * HOME_M) ** 2).all(axis=0)]
    of_second, of_third, between = squares.mean(axis=1)
    return float(np.sqrt(max(0.0, 0.5 * (of_second + of_third - between))))


def _places(T: Sequence[Matrix]) -> Matrix:
    """Return the positions (S, 3) of poses."""
    return np.array([one[:3, 3] for one in T])


def _apart_cm(a: Matrix, b: Matrix) -> list[float]:
    return [CM * float(distance_m) for distance_m in np.linalg.norm(a - b, axis=1)]


def _joined(results: Iterable[Result]) -> list[Result]:
    """Return the results with all samples of a question and contender in one."""
    samples: dict[tuple[str, str, str], list[float]] = {}
    for one in results:
        samples.setdefault((one.question, one.contender, one.unit), []).extend(one.samples)
    return [Result(*key, tuple(joined)) for key, joined in samples.items()]


def _result(question: str, contender_name: str, samples: Sequence[float]) -> Result:
    return Result(question, contender_name, "cm", tuple(samples))


QUESTION = Question(
    "accuracy",
    measure,
    (
        *(Goal(question, OWN, "within", 1.2) for question in JUDGED),
        Goal(OFF_EXACT_THINNED, OWN, "within", 0.35),
        Goal(CPU_THINNED, OWN, "within", 8.0),
    ),
    "all contenders in turn on the first usable CPU",
)
