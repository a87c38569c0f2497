# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Result of a `manycore doctor` check."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Verdict(Enum):
    """Outcome of a check."""

    OK = "ok"
    WARNING = "warning"  # works, but not as well as it could
    FAILURE = "failure"


@dataclass(frozen=True)
class Finding:
    """One line of the doctor: subject, finding, and advice."""

    subject: str
    verdict: Verdict
    found: str
    advice: str = ""


def judged(subject: str, is_good: bool, found: str, advice: str) -> Finding:
    """Return OK or a failure; only the failure carries the advice."""
    verdict = Verdict.OK if is_good else Verdict.FAILURE
    return Finding(subject, verdict, found, "" if is_good else advice)


def advised(subject: str, is_good: bool, found: str, advice: str) -> Finding:
    """Return OK or a warning; only the warning carries the advice."""
    verdict = Verdict.OK if is_good else Verdict.WARNING
    return Finding(subject, verdict, found, "" if is_good else advice)
