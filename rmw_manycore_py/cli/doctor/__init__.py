# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore doctor`."""

from __future__ import annotations

import sys
from collections.abc import Iterable

import click

from rmw_manycore_py.cli.common.options import examples, json_option
from rmw_manycore_py.cli.common.printing import print_json
from rmw_manycore_py.cli.doctor.finding import Finding, Verdict
from rmw_manycore_py.cli.doctor.install import check_install
from rmw_manycore_py.cli.doctor.machine import check_machine
from rmw_manycore_py.cli.doctor.writing import write_report
from rmw_manycore_py.errors import EXIT_FAILURE

COLOURS = {Verdict.OK: "green", Verdict.WARNING: "yellow", Verdict.FAILURE: "red"}


@click.command("doctor", epilog=examples("manycore doctor", "manycore doctor --report report.txt"))
@json_option
@click.option(
    "--report",
    "target",
    metavar="FILE",
    help="Write what a bug report needs to FILE (JSON for .json, - prints it) instead.",
)
@click.option("--mapfile", metavar="MAPFILE", help="Report this one, not those that are running.")
def command(as_json: bool, target: str | None, mapfile: str | None) -> None:
    """Check this machine and this installation; say what to do about what is wrong.

    The exit status is 0 when nothing fails; warnings do not count. A report has no messages in it,
    no secrets, and neither the user's name nor the host's; it is made whatever is broken.
    """
    if target is not None:
        write_report(target, mapfile, _findings)
        return
    findings = [*check_install(), *check_machine()]
    if as_json:
        print_json(_rows(findings))
    else:
        _show(findings)
    if any(finding.verdict is Verdict.FAILURE for finding in findings):
        sys.exit(EXIT_FAILURE)


def _findings() -> list[dict[str, str]]:
    return _rows([*check_install(), *check_machine()])


def _rows(findings: Iterable[Finding]) -> list[dict[str, str]]:
    return [{**vars(finding), "verdict": finding.verdict.value} for finding in findings]


def _show(findings: Iterable[Finding]) -> None:
    for finding in findings:
        verdict = click.style(f"{finding.verdict.value:<7}", fg=COLOURS[finding.verdict])
        click.echo(f"{verdict}  {finding.subject}: {finding.found}")
        if finding.advice:
            click.echo(f"{'':<7}  -> {finding.advice}")
