# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Packages made by `manycore interface build`, for `manycore interface list --built`."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any

from rmw_manycore_interfaces import hash_of
from rmw_manycore_py.cli.common.printing import echo, new_table, print_json, print_table
from rmw_manycore_py.cli.interface.kinds import of_kinds
from rmw_manycore_py.interfaces.store import Manifest, Store
from rmw_manycore_py.ros import ament


def print_built(kinds: Collection[str], as_json: bool) -> None:
    """Print the built packages with types of these kinds, and which version programs use."""
    store = Store()
    rows = list(_rows(store, kinds))
    if as_json:
        print_json(rows)
    elif not rows:
        echo(f"no packages built in {store.directory}")
    else:
        table = new_table("package", "#types", "built", "programs use")
        for row in rows:
            types = f"{len(row['types'])} of {row['available']}"
            table.add_row(row["package"], types, row["built"], row["state"])
        print_table(table)


def _rows(store: Store, kinds: Collection[str]) -> Iterator[dict[str, Any]]:
    for package, manifest in store.packages().items():
        types = list(of_kinds(manifest.types, kinds))
        if types:
            yield {
                "package": package,
                "types": types,
                "available": manifest.available,
                "built": manifest.built,
                "source": manifest.source,
                "prefix": str(store.entry(package, manifest.digest)),
                "state": _state(manifest),
            }


def _state(manifest: Manifest) -> str:
    """Return which package of this name programs use."""
    if ament.is_installed(manifest.package):
        return f"the one installed in {ament.package_prefix(manifest.package)}"
    for name, expected in manifest.dependencies.items():
        if hash_of(name) != expected:
            return f"neither: {name} has changed, build it again"
    return "this one"
