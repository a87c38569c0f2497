# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Kinds of guesses of a replay: their source, and what they take from the reference."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rmw_manycore_py.ndt.geometry import poses
from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.recordings.recording import Recording
from rmw_manycore_py.ndt.replay import motion, prediction
from rmw_manycore_py.ndt.replay.guess_source import (
    ANYWHERE,
    Approach,
    Guesses,
    GuessSource,
    StackInputs,
)
from rmw_manycore_py.process.progress import tracked

FIRST_OFF_M, FIRST_OFF_RAD = 0.3, 0.05  # error of an initial pose set in RViz
MADE_OF = {
    "odometry": "closed loop: last result and {motion}; a rough first pose",
    "velocity": "closed loop: EKF of the results alone; a rough first pose",
    "perturbed": "open loop: the REFERENCE pose, {offset:g} m and {turn:g} degrees off",
    "lost": "closed loop: EKF on the platform; no first pose, and speed by {motion}",
    "stack": "closed loop: EKF on the platform; a rough first pose, and speed by {motion}",
}
MOTION = {
    "scans": "the motion matched from scan to scan",
    "reference": "the REFERENCE's motion",
}


@dataclass(frozen=True)
class Motions:
    """Motions between scans without error, and which of them are the reference's, and why."""

    between: Sequence[Matrix] = ()
    untold: Sequence[str] = ()


@dataclass(frozen=True)
class GuessKind:
    """Settings of `--guess` and related options."""

    kind: str
    motion: str
    drift: float
    offset_m: float
    turn_deg: float
    seed: int

    def motions(self, drive: Recording) -> Motions:
        """Return the motions that this kind of guess needs.

        Motions that the scans do not determine are taken from the reference.
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
        """Describe the source of the guesses."""
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
        times_s = drive.times_s() if rate_hz is None else np.arange(len(drive)) / rate_hz
        periods_s = np.diff(times_s)
        if self.kind == "perturbed":
            perturbed = prediction.Perturbed(drive, self.offset_m, self.turn_deg, self.seed)
            reference = list(motion.of_reference(drive))
            return Guesses(first_pose, perturbed, _lead_in(drive.poses[0], reference, periods_s))
        if self.kind == "velocity":
            return Guesses(first_pose, prediction.Velocity(first_pose))
        drifted = [motion.drifted(one, self.drift, generator) for one in motions.between]
        if self.kind == "odometry":
            odometry = prediction.Odometry(first_pose, drifted)
            return Guesses(first_pose, odometry, _lead_in(first_pose, drifted, periods_s))
        if self.kind == "lost":
            return StackInputs(_upright(drive.poses), drifted, periods_s, ANYWHERE)
        return StackInputs(first_pose, drifted, periods_s)


def _upright(T: Matrix) -> Matrix:
    """Return the middle of poses (S, 4, 4), with the first one's roll and pitch: gravity."""
    roll, pitch, _ = poses.to_rpy(T[0])
    return poses.from_xyz_rpy(T[:, :3, 3].mean(axis=0), (roll, pitch, 0.0))


def _lead_in(T: Matrix, motions: Sequence[Matrix], periods_s: Matrix) -> Approach | None:
    """Return the drive up to the first scan; None if there is no second one."""
    return Approach(T, motions[0], float(periods_s[0])) if len(motions) > 0 else None
