# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The kinds of guesses a replay can make, what each takes from the reference, and its source."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.recordings.recording import Recording
from rmw_manycore_py.ndt.replay import motion, prediction
from rmw_manycore_py.ndt.replay.guess_source import Guesses, GuessSource, StackInputs
from rmw_manycore_py.progress import tracked

FIRST_OFF_M, FIRST_OFF_RAD = 0.3, 0.05  # how rough a first pose is, pointed at in RViz
MADE_OF = {
    "odometry": "closed loop: last result and {motion}; a rough first pose",
    "velocity": "closed loop: EKF of the results alone; a rough first pose",
    "perturbed": "open loop: the REFERENCE pose, {offset:g} m and {turn:g} degrees off",
    "stack": "closed loop: EKF on the platform; a rough first pose, and speed by {motion}",
}
MOTION = {
    "scans": "the motion matched from scan to scan",
    "reference": "the REFERENCE's motion",
}


@dataclass(frozen=True)
class Motions:
    """The motions between scans, without error, and why some of them are the reference's."""

    between: Sequence[Matrix] = ()
    untold: Sequence[str] = ()


@dataclass(frozen=True)
class GuessKind:
    """What `--guess` and the options beside it say."""

    kind: str
    motion: str
    drift: float
    offset_m: float
    turn_deg: float
    seed: int

    def motions(self, drive: Recording) -> Motions:
        """Return the motions that this kind of guess needs.

        Where two scans do not tell their motion it is the reference's.
        """
        if self.kind in ("perturbed", "velocity"):
            return Motions()
        reference = list(motion.of_reference(drive))
        if self.motion == "reference":
            return Motions(reference)
        untold: list[str] = []
        found = motion.of_scans(drive, untold.append)
        told = tracked(found, "motion", len(reference))
        between = [
            theirs if own is None else own for own, theirs in zip(told, reference, strict=True)
        ]
        return Motions(between, untold)

    def made_of(self, motions: Motions) -> str:
        """Say what the guesses are made of."""
        moved_by = f"{MOTION[self.motion]} with {self.drift:.0%} error"
        made_of = MADE_OF[self.kind].format(
            motion=moved_by, offset=self.offset_m, turn=self.turn_deg
        )
        if not motions.untold:
            return made_of
        count = f"{len(motions.untold)} of {len(motions.between)} motions"
        return (
            f"{made_of}; {count} the REFERENCE's, untold by scans (the first {motions.untold[0]})"
        )

    def source(self, drive: Recording, motions: Motions, rate_hz: float | None) -> GuessSource:
        """Return the source of guesses for a recording played by its stamps or at a rate."""
        generator = np.random.default_rng(self.seed)
        first_pose = poses.perturbed(drive.poses[0], FIRST_OFF_M, FIRST_OFF_RAD, generator)
        if self.kind == "perturbed":
            perturbed = prediction.Perturbed(drive, self.offset_m, self.turn_deg, self.seed)
            return Guesses(first_pose, perturbed)
        if self.kind == "velocity":
            return Guesses(first_pose, prediction.Velocity(first_pose))
        drifted = [motion.drifted(one, self.drift, generator) for one in motions.between]
        if self.kind == "odometry":
            return Guesses(first_pose, prediction.Odometry(first_pose, drifted))
        times_s = drive.times_s() if rate_hz is None else np.arange(len(drive)) / rate_hz
        return StackInputs(first_pose, drifted, np.diff(times_s))
