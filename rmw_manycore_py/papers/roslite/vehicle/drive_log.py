# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What became of each scan."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

MS = 1e-6  # per nanosecond
DEADLINE_MS = 100.0


@dataclass
class DriveLog:
    """Times by the stamp of the scan, in ns."""

    commands_ns: dict[int, int | None] = field(default_factory=dict)  # first command from it
    planned_ns: dict[int, int] = field(default_factory=dict)  # first lane planned from its pose
    loops: list[tuple[float, int]] = field(default_factory=list)  # ms and passes of alignments
    lateral_m: list[float] = field(default_factory=list)
    driven_m: float = 0.0

    def sent(self, stamp_ns: int) -> None:
        """Count a scan."""
        self.commands_ns[stamp_ns] = None

    def commanded(self, stamp_ns: int, now_ns: int) -> None:
        """Take a command; only the first from a counted scan matters."""
        if self.commands_ns.get(stamp_ns, now_ns) is None:
            self.commands_ns[stamp_ns] = now_ns

    def planned(self, stamp_ns: int, now_ns: int) -> None:
        """Take a planned lane, likewise."""
        if stamp_ns in self.commands_ns:
            self.planned_ns.setdefault(stamp_ns, now_ns)

    def figures(self) -> DriveFigures:
        """Return the figures of the drive, in ms and m."""
        answered = {stamp: at for stamp, at in self.commands_ns.items() if at is not None}
        return DriveFigures(
            scans=len(self.commands_ns),
            lost=len(self.commands_ns) - len(answered),
            to_command_ms=[MS * (at - stamp) for stamp, at in answered.items()],
            to_plan_ms=[MS * (at - stamp) for stamp, at in self.planned_ns.items()],
            alignment_ms=[ms for ms, _ in self.loops],
            passes=[passes for _, passes in self.loops],
            lateral_m=self.lateral_m,
            driven_m=self.driven_m,
        )


@dataclass(frozen=True)
class DriveFigures:
    """Figures of a drive."""

    scans: int
    lost: int  # no command came from them
    to_command_ms: list[float]
    to_plan_ms: list[float]
    alignment_ms: list[float]
    passes: list[int]
    lateral_m: list[float]
    driven_m: float

    @property
    def late(self) -> int:
        """Number of scans from which no command came within the deadline."""
        return self.lost + sum(ms > DEADLINE_MS for ms in self.to_command_ms)

    @property
    def loop_ms(self) -> list[float]:
        """Time of one pass, of each alignment."""
        return [ms / n for ms, n in zip(self.alignment_ms, self.passes, strict=True)]

    def write(self, path: Path) -> None:
        """Write them whole, or not at all."""
        part = path.with_suffix(".part")
        part.write_text(json.dumps(asdict(self)))
        part.replace(path)

    @classmethod
    def read(cls, path: Path) -> DriveFigures:
        """Return the figures of a file."""
        found: Mapping[str, object] = json.loads(path.read_text())
        return cls(**found)  # type: ignore[arg-type]
