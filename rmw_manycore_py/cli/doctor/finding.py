# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a check of `manycore doctor` found."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Verdict(Enum):
    """How a check came out."""

    OK = "ok"
    WARNING = "warning"  # works, but not as well as it could
    FAILURE = "failure"


@dataclass(frozen=True)
class Finding:
    """One line of the doctor: what was looked at, what was found, what to do about it."""

    subject: str
    verdict: Verdict
    found: str
    advice: str = ""


def judged(subject: str, is_good: bool, found: str, advice: str) -> Finding:
    """Return a finding that is good or a failure; advice is for the failure."""
    verdict = Verdict.OK if is_good else Verdict.FAILURE
    return Finding(subject, verdict, found, "" if is_good else advice)


def advised(subject: str, is_good: bool, found: str, advice: str) -> Finding:
    """Return a finding that is good or a warning; advice is for the warning."""
    verdict = Verdict.OK if is_good else Verdict.WARNING
    return Finding(subject, verdict, found, "" if is_good else advice)
