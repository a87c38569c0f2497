# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Doctor check: interface packages built locally, and which of them programs use."""

from __future__ import annotations

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
        if reason := _why_unused(manifest):
            remove = f"`manycore interface remove {package}`"
            advice = f"`manycore interface build {manifest.source}`, or {remove}"
            yield Finding(SUBJECT, Verdict.WARNING, f"{package}: {reason}", advice)


def _why_unused(manifest: Manifest) -> str | None:
    if ament.is_installed(manifest.package):
        return f"programs use the package installed in {ament.package_prefix(manifest.package)}"
    for name, expected in manifest.dependencies.items():
        if hash_of(name) != expected:
            return f"{name} has changed since the package was built"
    return None
