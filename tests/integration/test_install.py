# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The wheel: its content, and its use where nothing else is installed.

The wheel of the running Python is packed from what the set-up compiled; `make stress` builds one
for each Python with build isolation, as `pip install .` does.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from zipfile import ZipFile

import pytest

from support import MAPFILES, REPOSITORY
from support.installs.installing import Installation, build_wheel, run
from support.processes.platforms import environment, unique_platform
from support.sources.doc_commands import script

pytestmark = [pytest.mark.integration, pytest.mark.long]

BUILT_MESSAGES = {path.name for path in (REPOSITORY / "interfaces").iterdir()}
STAND_INS = {"librmw_fastrtps_cpp.so", "librmw_fastrtps_shared_cpp.so", "libfastrtps.so.2.14"}
ROS_LIBRARY = re.compile(r"lib(rmw|rcl|rcutils|rcpputils|rosidl_|fastcdr|fastrtps|tracetools)\w*\.")
STARTUP = (
    "arrays",
    "executor",
    "fields",
    "hook",
    "interfaces",
    "loading",
    "program",
    "receive",
    "distribution",
)


def pythons() -> Iterator[Path]:
    """Return the supported Python interpreters of this machine."""
    yield Path(sys.executable)
    root = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    for minor in {10, 11, 12, 13} - {sys.version_info.minor}:
        installed = sorted(root.glob(f"versions/3.{minor}.*/bin/python3"))
        if found := shutil.which(f"/usr/bin/python3.{minor}"):
            installed.append(Path(found))
        yield from installed[:1]


@pytest.fixture(scope="module")
def unpacked(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("unpacked")
    with ZipFile(wheel) as archive:
        archive.extractall(directory)
    return directory


@pytest.fixture(scope="module")
def prefix(unpacked: Path) -> Path:
    """Return what the wheel installs below sys.prefix, next to bin/ and lib/pythonX.Y."""
    return next(unpacked.glob("*.data/data"))


@pytest.fixture(scope="module")
def native_files(unpacked: Path) -> list[Path]:
    files = [path for path in unpacked.rglob("*") if path.is_file()]
    found = [path for path in files if path.read_bytes()[:4] == b"\x7fELF"]
    assert found
    return found


def test_no_ros_library_is_copied(native_files: list[Path]) -> None:
    named_like_ros = {path for path in native_files if ROS_LIBRARY.match(path.name)}
    stand_ins = {path for path in named_like_ros if path.parent.name == "standin"}
    assert {path.name for path in stand_ins} == STAND_INS
    assert {path.name for path in named_like_ros - stand_ins} == {"librmw_manycore.so"}


def test_nothing_names_the_build_machine(native_files: list[Path]) -> None:
    for path in native_files:
        paths = re.findall(r"(?:RPATH|RUNPATH).*\[(.*)\]", run("readelf", "-d", path))
        assert all(part.startswith("$ORIGIN") for found in paths for part in found.split(":"))


def test_no_path_of_the_build_machine_is_in_the_files(
    wheel: Path, native_files: list[Path]
) -> None:
    """Neither in messages, which name the source file, nor in debug information."""
    machine = [str(REPOSITORY).encode(), str(wheel.parent).encode()]
    assert [path for path in native_files for name in machine if name in path.read_bytes()] == []


def names_a_source(found: bytes) -> bool:
    """Return whether bytes end with the name of a file of the checkout, whatever precedes it."""
    starts = [at for at in range(len(found)) if found[at - 1 : at] not in (b"/", b".")]
    return any((REPOSITORY / found[at:].decode()).is_file() for at in starts)


def test_messages_name_source_files_as_the_checkout_does(prefix: Path) -> None:
    sources = re.findall(rb"[\w/.-]+\.cpp\b", (prefix / "lib/librmw_manycore.so").read_bytes())
    assert sources
    assert [name for name in sources if not names_a_source(name)] == []


def test_only_the_rmw_interface_is_exported(prefix: Path) -> None:
    library = prefix / "lib/librmw_manycore.so"
    names = {line.split()[0] for line in run("nm", "-DP", "--defined-only", library).splitlines()}
    assert names
    assert [name for name in names if not name.startswith("rmw_")] == []


def test_every_function_of_the_rmw_interface_is_exported(prefix: Path) -> None:
    """Every function that rmw_fastrtps_cpp exports is exported."""
    ours = run("nm", "-DP", "--defined-only", prefix / "lib/librmw_manycore.so")
    theirs = run("nm", "-DP", "--defined-only", Path(sys.prefix) / "lib/librmw_fastrtps_cpp.so")
    functions = re.compile(r"^(rmw_\w+) T", re.MULTILINE)
    assert set(functions.findall(theirs)) - set(functions.findall(ours)) == set()


def test_the_stand_in_brings_the_middleware(prefix: Path) -> None:
    stand_in = prefix / "lib/rmw_manycore/standin/librmw_fastrtps_cpp.so"
    assert "[librmw_manycore.so]" in run("readelf", "-d", stand_in)


@pytest.mark.parametrize("kind", ["rmw_typesupport", "rmw_typesupport_c", "rmw_typesupport_cpp"])
def test_an_ordinary_ros_finds_the_middleware(prefix: Path, kind: str) -> None:
    entry = prefix / "share/ament_index/resource_index" / kind / "rmw_manycore"
    assert "rosidl_typesupport_fastrtps" in entry.read_text()


def test_top_level_names(unpacked: Path) -> None:
    found = (path.name for path in unpacked.iterdir())
    names = {
        name.partition(".cpython-")[0] for name in found if not name.startswith("rmw_manycore-")
    }
    modules = {f"rmw_manycore_{name}.py" for name in STARTUP}
    startup = {"rmw_manycore.pth", "_rmw_manycore_arrays", "_rmw_manycore_fields", *modules}
    assert names == startup | {"rmw_manycore_bridge", "rmw_manycore_py"} | BUILT_MESSAGES


def test_fast_dds_is_not_loaded() -> None:
    show = "import rclpy.impl.implementation_singleton; print(open('/proc/self/maps').read())"
    maps = run(sys.executable, "-c", show, env=environment(unique_platform()))
    loaded = {Path(line.split()[-1]) for line in maps.splitlines() if ".so" in line}
    assert Path(sys.prefix) / "lib/librmw_manycore.so" in loaded
    replaced = {path for path in loaded if path.name.startswith(("libfastrtps", "librmw_fastrtps"))}
    assert {path.parent.name for path in replaced} == {"standin"}


@pytest.mark.stress
@pytest.mark.parametrize("python", list(pythons()), ids=str)
def test_what_pip_builds_runs_a_mapfile(python: Path, tmp_path: Path, start) -> None:
    installation = Installation(python, build_wheel(python, tmp_path), tmp_path / "venv")
    nodes = start([installation.manycore, "run", MAPFILES / "talker_listener.yaml"])
    nodes.wait_for("I heard")
    assert nodes.stop() == 0, nodes


@pytest.mark.stress
def test_the_first_commands_of_the_readme(wheel: Path, tmp_path: Path, platform: str) -> None:
    """They name no version: pip finds the wheel of the Python at hand."""
    (tmp_path / "dist").mkdir()
    shutil.copy(wheel, tmp_path / "dist")
    typed = script(REPOSITORY / "README.md").partition("make demo")[0]
    path = f"{sys.base_prefix}/bin:{os.environ['PATH']}"
    output = run("bash", "-ec", typed, cwd=tmp_path, env=environment(platform, PATH=path))
    assert "I heard: 'Hello World" in output
