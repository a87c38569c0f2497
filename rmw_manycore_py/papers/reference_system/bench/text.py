# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parses the output of the reference system's nodes."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field

_PATH = re.compile(r"sample path: \((?P<node>.+)\)")
_ROW = re.compile(r"  \[ *\d+\]  (?P<stamp>\d+) +(?P<number>\w+) +(?P<name>\w+) +\d+ \[")
_STATISTIC = re.compile(r"  (?P<name>[a-z ]+): +(?P<current>[0-9.e+-]+)(ms)? \[")
_LOST = re.compile(r"lost (?P<count>\d+) of (?P<topic>\S+) at (?P<stamp>\d+)")
_ENDPOINT = "endpoint"


@dataclass
class Report:
    """One message at a command node: its path, and the current value of each statistic."""

    node: str
    stamp_ns: int = 0
    sequences: dict[str, int] = field(default_factory=dict)
    stamps_ns: dict[str, int] = field(default_factory=dict)
    statistics: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Loss:
    """Lost messages of a topic, as reported at a time of the system clock."""

    count: int
    topic: str
    stamp_ns: int


def reports_in(text: str) -> list[Report]:
    """Return all messages reported by command nodes, including those without statistics."""
    reports: list[Report] = []
    for line in text.splitlines():
        if path := _PATH.fullmatch(line):
            reports.append(Report(path["node"]))
        elif reports:
            _add(reports[-1], line)
    return reports


def losses_in(text: str) -> list[Loss]:
    """Return all losses reported by nodes."""
    found = (_LOST.fullmatch(line) for line in text.splitlines())
    return [Loss(int(m["count"]), m["topic"], int(m["stamp"])) for m in found if m]


def values(reports: Iterable[Report], statistic: str) -> list[float]:
    """Return the values of a statistic, one per report that has it."""
    return [r.statistics[statistic] for r in reports if statistic in r.statistics]


def _add(report: Report, line: str) -> None:
    if row := _ROW.match(line):
        if row["number"] == _ENDPOINT:
            report.stamp_ns = int(row["stamp"])
        else:
            report.sequences[row["name"]] = int(row["number"])
            report.stamps_ns[row["name"]] = int(row["stamp"])
    elif statistic := _STATISTIC.match(line):
        report.statistics[statistic["name"]] = float(statistic["current"])
