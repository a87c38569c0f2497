# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Doctor check: interface packages built locally, and which of them programs use."""

from __future__ import annotations

import shlex
from collections.abc import Iterator

from rmw_manycore_interfaces import hash_of
from rmw_manycore_py.cli.doctor.finding import Finding, Verdict
from rmw_manycore_py.interfaces.store import Manifest, Store
from rmw_manycore_py.ros import ament

SUBJECT = "built interfaces"


def check_built() -> Iterator[Finding]:
    """Yield the packages of `manycore interface build`, then each that programs cannot use."""
    store = Store()
    try:
        packages = store.packages()
    except (OSError, ValueError, TypeError) as error:
        advice = f"remove {store.directory} and build the packages again"
        yield Finding(SUBJECT, Verdict.FAILURE, f"{store.directory}: {error}", advice)
        return
    if not packages:
        yield Finding(SUBJECT, Verdict.OK, f"none in {store.directory}")
        return
    names = ", ".join(packages)
    yield Finding(SUBJECT, Verdict.OK, f"{names} in {store.directory}")
    for package, manifest in packages.items():
        remove = f"`manycore interface remove {package}`"
        if ament.is_installed(package):
            found = f"programs use the package installed in {ament.package_prefix(package)}"
            yield Finding(SUBJECT, Verdict.WARNING, f"{package}: {found}", remove)
        elif changed := _changed(manifest):
            found = f"{changed} has changed since the package was built"
            advice = f"`manycore interface build {shlex.quote(manifest.source)}`, or {remove}"
            yield Finding(SUBJECT, Verdict.WARNING, f"{package}: {found}", advice)


def _changed(manifest: Manifest) -> str | None:
    """Return a type of another package that a built package was not built for."""
    needed = manifest.dependencies.items()
    return next((name for name, expected in needed if hash_of(name) != expected), None)
