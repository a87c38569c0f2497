# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Directory of built packages, with atomic updates.

lock                    held by the one build or removal at a time
building/               what builds work in; leftovers of killed ones
store/PACKAGE-DIGEST/   complete packages: python/, lib/, include/, share/
views/N/                links into the store: an install prefix
current -> views/N      the one that programs see; replaced by rename(2)
"""

from __future__ import annotations

import fcntl
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

from rmw_manycore_interfaces import DIRECTORY_VARIABLE, MANIFEST, own_directory
from rmw_manycore_py.errors import ManycoreError

_INDEX = "share/ament_index/resource_index"


@dataclass(frozen=True)
class Manifest:
    """Description of a built package."""

    package: str
    digest: str  # hash of all inputs of the build
    types: list[str]
    available: int  # number of definitions in the package
    dependencies: dict[str, str]  # hashes of the types of other packages, by name
    source: str
    built: str  # local time, ISO 8601
    seconds: float

    @property
    def is_whole(self) -> bool:
        """Return whether the whole package was built."""
        return len(self.types) == self.available


class Store:
    """Packages built for this Python; modified only under `locked()`."""

    def __init__(self) -> None:
        self.directory = Path(own_directory())

    @contextmanager
    def locked(self, on_wait: Callable[[], None]) -> Iterator[None]:
        """Hold the build lock; call `on_wait` before waiting for another build."""
        with self._writing():  # parent directories may be unwritable, too
            self.directory.mkdir(parents=True, exist_ok=True)
            lock = (self.directory / "lock").open("w")
        with lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                on_wait()
                fcntl.flock(lock, fcntl.LOCK_EX)
            with self._writing():
                self._remove_leftovers()
                yield

    def packages(self) -> dict[str, Manifest]:
        """Return the visible packages, by name."""
        files = sorted(self.directory.glob(f"current/share/*/{MANIFEST}"))
        manifests = (Manifest(**json.loads(file.read_text())) for file in files)
        return {manifest.package: manifest for manifest in manifests}

    def entry(self, package: str, digest: str) -> Path:
        """Return the install prefix of a complete package, present or future."""
        return self.directory / "store" / f"{package}-{digest}"

    def has(self, package: str, digest: str) -> bool:
        """Return whether a package is complete, visible or not."""
        return (self.entry(package, digest) / "share" / package / MANIFEST).is_file()

    def new_directory(self) -> Path:
        """Return an empty build directory; the next build removes it."""
        building = self.directory / "building"
        building.mkdir(exist_ok=True)
        return Path(tempfile.mkdtemp(dir=building))

    def add(self, directory: Path, manifest: Manifest) -> Path:
        """Move a built package into the store, not visible yet."""
        file = directory / "share" / manifest.package / MANIFEST
        file.write_text(json.dumps(asdict(manifest), indent=1))
        entry = self.entry(manifest.package, manifest.digest)
        entry.parent.mkdir(exist_ok=True)
        if entry.exists():  # incomplete: it has no manifest
            shutil.rmtree(entry)
        directory.rename(entry)
        return entry

    def show(self, digests: Mapping[str, str]) -> None:
        """Make exactly these complete packages visible, atomically."""
        views = self.directory / "views"
        views.mkdir(exist_ok=True)
        view = Path(tempfile.mkdtemp(dir=views))
        view.chmod(0o755)
        for package, digest in digests.items():
            _link(view, self.entry(package, digest), package)
        link = Path(f"{view}.link")
        link.symlink_to(view.relative_to(self.directory))
        link.rename(self.directory / "current")
        self._remove_leftovers()
        self._keep("store", {f"{package}-{digest}" for package, digest in digests.items()})

    def _remove_leftovers(self) -> None:
        """Remove leftovers of killed builds and replaced views."""
        current = self.directory / "current"
        self._keep("building", ())
        self._keep("views", [Path(os.readlink(current)).name] if current.is_symlink() else ())

    def _keep(self, folder: str, names: Collection[str]) -> None:
        for path in sorted((self.directory / folder).glob("*")):
            if path.is_symlink():
                path.unlink()
            elif path.name not in names:
                shutil.rmtree(path)

    @contextmanager
    def _writing(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            place = str(error.filename)
            if not (place.startswith(str(self.directory)) or str(self.directory).startswith(place)):
                raise
            raise ManycoreError(
                f"{error.filename}: cannot be written: {error.strerror}; set {DIRECTORY_VARIABLE} "
                "to a writable directory for built packages"
            ) from error


def _link(view: Path, entry: Path, package: str) -> None:
    target = Path("../../..") / "store" / entry.name
    for folder in ("python", "include", "share"):
        (view / folder).mkdir(exist_ok=True)
        (view / folder / package).symlink_to(target / folder / package)
    (view / "lib").mkdir(exist_ok=True)
    for library in sorted((entry / "lib").iterdir()):
        (view / "lib" / library.name).symlink_to(target / "lib" / library.name)
    for kind in ("packages", "rosidl_interfaces"):
        index = view / _INDEX / kind
        index.mkdir(parents=True, exist_ok=True)
        (index / package).symlink_to("../../.." / target / _INDEX / kind / package)
