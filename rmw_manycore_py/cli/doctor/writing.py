# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore doctor --report`: write the report."""

from __future__ import annotations

from pathlib import Path

from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.doctor.report import Section, as_json, as_text, report
from rmw_manycore_py.errors import ManycoreError

PRINTED = "-"


def write_report(
    target: str, mapfile: str | None, findings: Section, *, packages: bool = True
) -> None:
    """Make a report and write it to a file or standard output."""
    sections = report(findings, mapfile, packages=packages)
    text = as_json(sections) if Path(target).suffix == ".json" else as_text(sections)
    if target == PRINTED:
        echo(text, nl=False)
        return
    try:
        Path(target).write_text(text, encoding="utf-8")
    except OSError as error:
        raise ManycoreError(f"{target}: cannot be written: {error.strerror}") from error
    echo(f"written to {target}; review it before sharing")
