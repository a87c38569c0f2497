# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Compiles generated sources to the libraries and the Python module of a package."""

from __future__ import annotations

import sysconfig
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_py.interfaces.generator import PYTHON, TYPE_SUPPORTS
from rmw_manycore_py.interfaces.jobs import Job, usable_cpus
from rmw_manycore_py.interfaces.toolchain import Toolchain

# -O2 takes half as long again without a measurable gain.
_FLAGS = ("-O1", "-fPIC", "-w", "-fvisibility=default")
# Maximum size of unity builds, for small and large packages: headers cost more than the sources,
# but a single unit must not occupy one CPU after the others are done.
_SMALL_UNIT_BYTES, _LARGE_UNIT_BYTES = 400_000, 1_000_000
# Compiled alone: each source defines constants of the same names.
_ALONE = "__description.c"
# Generators of the libraries, in link order.
_C_LIBRARIES = ("rosidl_generator_c", *TYPE_SUPPORTS, "rosidl_typesupport_c")
LIBRARIES = (*_C_LIBRARIES, PYTHON)
_MODULE = "module"


@dataclass(frozen=True)
class Compilation:
    """A package to compile: sources below `generated`, results below `prefix`."""

    package: str
    generated: Path
    prefix: Path
    toolchain: Toolchain
    dependencies: dict[str, Path]  # install prefixes of other packages

    def shared_object_of(self, kind: str) -> Path:
        """Return the path of a library of the package, e.g. of rosidl_typesupport_c."""
        return self.prefix / "lib" / f"lib{self.package}__{kind}.so"

    @property
    def module(self) -> Path:
        """Return the path of the extension module."""
        suffix = sysconfig.get_config_var("EXT_SUFFIX")
        name = f"{self.package}_s__rosidl_typesupport_c{suffix}"
        return self.prefix / "python" / self.package / name


def compile_jobs(work: Compilation) -> list[Job]:
    """Return the compile commands, longest first."""
    jobs = []
    roots = {generator: work.generated / generator / work.package for generator in LIBRARIES}
    total = sum(source.stat().st_size for root in roots.values() for source in _sources(root))
    enough = max(_SMALL_UNIT_BYTES, min(_LARGE_UNIT_BYTES, total // (4 * usable_cpus())))
    for generator, root in roots.items():
        for number, sources in enumerate(_units(root, enough)):
            objects = _objects(work, _MODULE if sources[0].parent == root else generator)
            objects.mkdir(parents=True, exist_ok=True)
            unit = objects / f"{number}{sources[0].suffix}"
            unit.write_text("".join(f'#include "{source}"\n' for source in sources))
            size = sum(source.stat().st_size for source in sources)
            jobs.append((size, _compile_job(work, unit, sources)))
    return [job for _, job in sorted(jobs, key=lambda pair: -pair[0])]


def link_jobs(work: Compilation) -> Iterator[list[Job]]:
    """Yield groups of link commands; each group depends on the previous ones."""
    (work.prefix / "lib").mkdir(parents=True, exist_ok=True)
    generator_c, *type_supports, dispatch, python = LIBRARIES
    yield [_link_job(work, generator_c, [])]
    yield [_link_job(work, kind, [generator_c]) for kind in type_supports]
    yield [_link_job(work, dispatch, [generator_c, *type_supports])]
    yield [_link_job(work, python, [generator_c, dispatch])]
    yield [_module_job(work)]


def _sources(directory: Path) -> list[Path]:
    return sorted(file for file in directory.rglob("*.c*") if file.suffix in (".c", ".cpp"))


def _units(directory: Path, enough_bytes: int) -> Iterator[list[Path]]:
    """Yield sources to compile together: same language, same kind (msg, srv, action)."""
    unit: list[Path] = []
    size = 0
    for file in _sources(directory):
        if file.name.endswith(_ALONE):
            yield [file]
            continue
        size += file.stat().st_size
        if unit and (unit[-1].parent != file.parent or size > enough_bytes):
            yield unit
            unit, size = [], file.stat().st_size
        unit.append(file)
    if unit:
        yield unit


def _compile_job(work: Compilation, unit: Path, sources: Sequence[Path]) -> Job:
    tools = work.toolchain
    compiler = (*tools.cpp, "-std=c++17") if unit.suffix == ".cpp" else (*tools.c, "-std=c11")
    own = [work.generated / generator for generator in _C_LIBRARIES]
    others = [prefix / "include" / name for name, prefix in work.dependencies.items()]
    includes = [*own, *others, *tools.includes, tools.python_headers, tools.numpy_headers]
    flags = [word for path in includes for word in ("-isystem", str(path))]
    names = ", ".join(source.name for source in sources[:3])
    command = (*compiler, *_FLAGS, *flags, "-c", str(unit), "-o", f"{unit}.o")
    return Job(f"compiling {names} of {work.package}", command)


def _link_job(work: Compilation, kind: str, own: Iterable[str]) -> Job:
    library = work.shared_object_of(kind)
    others = [prefix / "lib" / f"lib{n}__{kind}.so" for n, prefix in work.dependencies.items()]
    libraries = [*(work.shared_object_of(name) for name in own), *filter(Path.exists, others)]
    # Search beside the library, then among the user's built packages, after the wheels and
    # LD_LIBRARY_PATH.
    flags = [f"-Wl,-soname,{library.name}", "-Wl,-rpath,$ORIGIN:$ORIGIN/../../../current/lib"]
    return _link(work, library, [_objects(work, kind)], libraries, flags)


def _module_job(work: Compilation) -> Job:
    """Link the extension module together with the libraries that are opened by name.

    rosidl_typesupport_c opens type support libraries by their bare names. The loader returns those
    already loaded by the module, so no search path is needed.
    """
    libraries = [work.shared_object_of(kind) for kind in LIBRARIES]
    flags = ["-Wl,--no-as-needed", "-Wl,-rpath,$ORIGIN/../../lib"]
    return _link(work, work.module, [_objects(work, _MODULE)], libraries, flags)


def _link(
    work: Compilation,
    target: Path,
    objects: Iterable[Path],
    libraries: Iterable[Path],
    flags: Iterable[str],
) -> Job:
    files = [str(file) for directory in objects for file in sorted(directory.glob("*.o"))]
    used = [str(library) for library in (*libraries, *work.toolchain.libraries)]
    options = ("-shared", "-Wl,--enable-new-dtags", "-Wl,--allow-shlib-undefined", *flags)
    command = (*work.toolchain.cpp, *options, "-o", str(target), *files, *used)
    return Job(f"linking {target.name}", command)


def _objects(work: Compilation, generator: str) -> Path:
    return work.generated / "objects" / generator
