# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore doctor`."""

from __future__ import annotations

import sys
from collections.abc import Iterable

import click

from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import echo, escaped, print_json
from rmw_manycore_py.cli.doctor.finding import Finding, Verdict
from rmw_manycore_py.cli.doctor.install import check_install
from rmw_manycore_py.cli.doctor.machine import check_machine
from rmw_manycore_py.cli.doctor.writing import PRINTED, write_report
from rmw_manycore_py.errors import EXIT_FAILURE

COLOURS = {Verdict.OK: "green", Verdict.WARNING: "yellow", Verdict.FAILURE: "red"}


@click.command(
    "doctor",
    epilog=examples("manycore doctor", "manycore doctor --report", "manycore doctor -r report.txt"),
)
@json_option
@click.option(
    "-r",
    "--report",
    "target",
    metavar="[FILE]",
    is_flag=False,
    flag_value=PRINTED,
    help="Print a bug report instead, or write it to FILE (as JSON if it ends in .json).",
)
@click.option(
    "-rf", "--report-failed", "failed_only", is_flag=True, help="Print only failed checks."
)
@click.option(
    "-ep",
    "--exclude-packages",
    "lean",
    is_flag=True,
    help="Leave package versions out of the report.",
)
@click.option(
    "-iw", "--include-warnings", "strict", is_flag=True, help="Count warnings as failures."
)
@click.option(
    "--mapfile", metavar="MAPFILE", help="Report this mapfile, not those of running platforms."
)
def command(
    as_json: bool,
    target: str | None,
    failed_only: bool,
    lean: bool,
    strict: bool,
    mapfile: str | None,
) -> None:
    """Check this machine and installation.

    Suggests a fix for each problem. The exit status is 0 unless a check fails; warnings do not
    count. A report contains no messages, no secrets, and neither user nor host name; sections
    that cannot be collected state the reason.
    """
    if target is not None:
        write_report(target, mapfile, lambda: _rows(_findings()), packages=not lean)
        return
    failures = {Verdict.FAILURE, Verdict.WARNING} if strict else {Verdict.FAILURE}
    findings = _findings()
    shown = [f for f in findings if f.verdict in failures] if failed_only else findings
    if as_json:
        print_json(_rows(shown))
    else:
        _show(shown)
    if any(finding.verdict in failures for finding in findings):
        sys.exit(EXIT_FAILURE)


def _findings() -> list[Finding]:
    return [*check_install(), *check_machine()]


def _rows(findings: Iterable[Finding]) -> list[dict[str, str]]:
    return [{**vars(finding), "verdict": finding.verdict.value} for finding in findings]


def _show(findings: Iterable[Finding]) -> None:
    for finding in findings:
        verdict = click.style(f"{finding.verdict.value:<7}", fg=COLOURS[finding.verdict])
        click.echo(f"{verdict}  {escaped(f'{finding.subject}: {finding.found}')}")
        if finding.advice:
            echo(f"{'':<7}  -> {finding.advice}")
