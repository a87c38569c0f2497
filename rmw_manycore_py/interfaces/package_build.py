# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Builds one package in its own directory."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from rosidl_pycommon import convert_camel_case_to_lower_case_underscore

from rmw_manycore_hook import plain_environment
from rmw_manycore_program import own_program
from rmw_manycore_py.errors import DefinitionError, Problem
from rmw_manycore_py.interfaces import generator
from rmw_manycore_py.interfaces.compiling import LIBRARIES, Compilation, compile_jobs, link_jobs
from rmw_manycore_py.interfaces.jobs import Job, JobError, run_jobs, usable_cpus
from rmw_manycore_py.interfaces.selection import Part
from rmw_manycore_py.interfaces.toolchain import Toolchain

# Relative generator time per definition. Starting a generator process takes as long as the smallest
# batch.
_WEIGHTS = {"msg": 1, "srv": 3, "action": 10}
_SMALLEST_BATCH = 8

_INIT = """# Written by `manycore interface build`.
from rmw_manycore_interfaces import check as _check

_check(__name__)
"""

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Built:
    """A package built in a directory with the layout of an install prefix."""

    prefix: Path
    dependencies: dict[str, str]  # hashes of contained types of other packages


def build_package(
    part: Part,
    directory: Path,
    toolchain: Toolchain,
    prefixes: Mapping[str, Path],
    on_progress: Progress,
) -> Built:
    """Build a package in an empty directory.

    :param prefixes: install prefixes of packages whose types it may contain.
    :raises DefinitionError: if a generator or compiler rejects a definition.
    """
    request = _request(part, directory, toolchain, prefixes)
    build = _PackageBuild(part, request, directory, on_progress)
    build.generate()
    dependencies = _dependencies(request)
    prefix = directory / "prefix"
    _install(part, request, prefix)
    used = {*part.needed, *(name.split("/")[0] for name in dependencies)}
    places = {package: prefixes[package] for package in sorted(used)}
    work = Compilation(part.package, directory / "generated", prefix, toolchain, places)
    build.run("compiling", compile_jobs(work))
    for jobs in link_jobs(work):
        build.run("linking", jobs)
    return Built(prefix, dependencies)


class _PackageBuild:
    """Runs generators and compilers of a package, reporting progress and errors."""

    def __init__(
        self, part: Part, request: generator.Request, directory: Path, on_progress: Progress
    ) -> None:
        self._part = part
        self._request = request
        self._directory = directory
        self._on_progress = on_progress
        self._environment = plain_environment(os.environ, sys.prefix)
        self._environment.pop("RMW_IMPLEMENTATION", None)

    def generate(self) -> None:
        """Run the generators: descriptions first, since the code contains their hashes."""
        everything = self._request.definitions
        self.run("reading", [self._job("describe", everything)])
        jobs = [self._job("python", everything)]
        jobs += [self._job("code", batch) for batch in _batches(everything)]
        self.run("generating", jobs)
        generator.write_visibility_headers(self._request)

    def run(self, what: str, jobs: Sequence[Job]) -> None:
        """Run jobs; an error names the definition if the output identifies it."""

        def on_done(done: int) -> None:
            self._on_progress(f"{what} ({done} of {len(jobs)})")

        self._on_progress(what)
        try:
            run_jobs(jobs, self._directory, self._environment, on_done)
        except JobError as error:
            file = self._blamed(error.output)
            if file is None:
                raise
            raise DefinitionError(
                Problem(file, 0, "", "a definition that can be built", str(error))
            ) from error

    def _blamed(self, output: str) -> Path | None:
        """Return the definition whose generated files are mentioned first in an output."""
        found: dict[int, Path] = {}
        for definition in self._part.definitions:
            stem = convert_camel_case_to_lower_case_underscore(definition.file.stem)
            for mention in (f"/{stem}__", f"/_{stem}_s.c", f"/{definition.file.name}"):
                if (place := output.find(mention)) >= 0:
                    found.setdefault(place, definition.file)
        return found[min(found)] if found else None

    def _job(self, step: str, definitions: Sequence[str]) -> Job:
        request = {**asdict(self._request), "definitions": list(definitions)}
        file = self._directory / f"{step}-{definitions[0].replace('/', '.')}.json"
        file.write_text(json.dumps(request))
        command = own_program(generator.__name__, step, str(file))
        return Job(f"generating {self._part.package}", command)


def _request(
    part: Part, directory: Path, toolchain: Toolchain, prefixes: Mapping[str, Path]
) -> generator.Request:
    return generator.Request(
        package=part.package,
        source=str(part.directory),
        definitions=[f"{d.kind}/{d.file.name}" for d in part.definitions],
        output=str(directory / "generated"),
        share=str(toolchain.ros / "share"),
        dependencies={name: str(prefix / "share" / name) for name, prefix in prefixes.items()},
    )


def _batches(definitions: Sequence[str]) -> Iterator[list[str]]:
    """Yield batches of definitions, at most two per CPU."""
    weights = {name: _WEIGHTS[name.split("/")[0]] for name in definitions}
    enough = max(_SMALLEST_BATCH, sum(weights.values()) / (2 * usable_cpus()))
    batch: list[str] = []
    weight = 0
    for name in definitions:
        weight += weights[name]
        batch.append(name)
        if weight >= enough:
            yield batch
            batch, weight = [], 0
    if batch:
        yield batch


def _dependencies(request: generator.Request) -> dict[str, str]:
    """Return the hashes of all types of other packages used directly or indirectly."""
    found: dict[str, str] = {}
    for idl in request.idl():
        for description in request.description(idl).parent.glob("*.json"):
            for entry in json.loads(description.read_text()).get("type_hashes", ()):
                found[entry["type_name"]] = entry["hash_string"]
    own = f"{request.package}/"
    return {name: found[name] for name in sorted(found) if not name.startswith(own)}


def _install(part: Part, request: generator.Request, prefix: Path) -> None:
    """Install the files that are not compiled: Python, headers, definitions, index entries."""
    package = part.package
    python = request.place(generator.PYTHON)
    _copy(python, prefix / "python" / package, "*/*.py")
    (prefix / "python" / package / "__init__.py").write_text(_INIT)
    for name in LIBRARIES:
        _copy(request.place(name), prefix / "include" / package / package, "**/*.h")
    share = prefix / "share" / package
    _copy(request.place("idl"), share, "*/*.idl")
    _copy(request.place(generator.DESCRIPTION), share, "*/*.json")
    for definition in part.definitions:
        shutil.copyfile(definition.file, share / definition.kind / definition.file.name)
    index = prefix / "share/ament_index/resource_index"
    names = "".join(f"{name}\n" for name in request.definitions)
    for kind, text in (("packages", ""), ("rosidl_interfaces", names)):
        (index / kind).mkdir(parents=True)
        (index / kind / package).write_text(text)


def _copy(source: Path, target: Path, pattern: str) -> None:
    for file in sorted(source.glob(pattern)):
        place = target / file.relative_to(source)
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, place)
