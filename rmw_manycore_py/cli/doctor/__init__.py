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
from rmw_manycore_py.errors import EXIT_FAILURE

COLOURS = {Verdict.OK: "green", Verdict.WARNING: "yellow", Verdict.FAILURE: "red"}


@click.command("doctor", epilog=examples("manycore doctor"))
@json_option
def command(as_json: bool) -> None:
    """Check this machine and this installation; say what to do about what is wrong.

    The exit status is 0 when nothing fails; warnings do not count.
    """
    findings = [*check_install(), *check_machine()]
    if as_json:
        print_json([{**vars(finding), "verdict": finding.verdict.value} for finding in findings])
    else:
        _show(findings)
    if any(finding.verdict is Verdict.FAILURE for finding in findings):
        sys.exit(EXIT_FAILURE)


def _show(findings: Iterable[Finding]) -> None:
    for finding in findings:
        verdict = click.style(f"{finding.verdict.value:<7}", fg=COLOURS[finding.verdict])
        click.echo(f"{verdict}  {finding.subject}: {finding.found}")
        if finding.advice:
            click.echo(f"{'':<7}  -> {finding.advice}")
