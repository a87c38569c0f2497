# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The bug report in one file: versions, machine, platforms, mapfiles."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

from rmw_manycore_py.cli.doctor.report.bridges import bridges
from rmw_manycore_py.cli.doctor.report.environment import environment
from rmw_manycore_py.cli.doctor.report.limits import kernel_settings, limits
from rmw_manycore_py.cli.doctor.report.logs import recent_lines
from rmw_manycore_py.cli.doctor.report.machine import machine
from rmw_manycore_py.cli.doctor.report.mapfiles import mapfiles
from rmw_manycore_py.cli.doctor.report.platforms import platforms
from rmw_manycore_py.cli.doctor.report.privacy import anonymous
from rmw_manycore_py.cli.doctor.report.versions import versions
from rmw_manycore_py.errors import what_is_wrong

MAPFILES = "mapfiles"
Section = Callable[[], Any]

_HEAD = "# Report of manycore doctor. It contains no messages; review it before sharing.\n"


def report(findings: Section, mapfile: str | None, *, packages: bool = True) -> dict[str, Any]:
    """Return all sections; a section without data states the reason.

    :param findings: the doctor's findings.
    :param mapfile: path or name of a mapfile; default: those of running platforms.
    :param packages: whether to list the versions of installed packages.
    """
    sections: Mapping[str, Section] = {
        "versions": lambda: versions(packages=packages),
        "machine": machine,
        "limits": limits,
        "kernel settings": kernel_settings,
        "environment": environment,
        "checks": findings,
        "platforms": platforms,
        "bridges": bridges,
        MAPFILES: lambda: mapfiles(mapfile),
        "log": recent_lines,
    }
    return {
        name: anonymous(_filled(section), keys=name == MAPFILES)
        for name, section in sections.items()
    }


def as_text(sections: Mapping[str, Any]) -> str:
    """Format the report as YAML, or as JSON without PyYAML."""
    try:
        import yaml
    except ImportError:  # without PyYAML
        return _HEAD + as_json(sections)
    return _HEAD + yaml.safe_dump(dict(sections), sort_keys=False, allow_unicode=True, width=1000)


def as_json(sections: Mapping[str, Any]) -> str:
    """Format the report as JSON."""
    return json.dumps(sections, indent=2) + "\n"


def _filled(section: Section) -> Any:
    try:
        return section() or "nothing found"
    except Exception as error:  # report what is broken, keep the other sections
        return f"not available: {type(error).__name__}: {what_is_wrong(error)}"
