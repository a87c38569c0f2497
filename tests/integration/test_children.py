# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The middleware that children of a Python program load, C++ programs above all."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

import rmw_manycore_hook as hook
from rmw_manycore_hook import library_path
from support import IS_MANYCORE, TESTS, TIMEOUT_S
from support.processes.commands import manycore_command
from support.processes.platforms import environment
from support.session.sharing import made_once

if not IS_MANYCORE:
    pytest.skip("is about rmw_manycore in the place of Fast DDS", allow_module_level=True)

pytestmark = pytest.mark.integration

PREFIX = Path(sys.prefix)
STAND_INS = Path(hook.stand_in_directory(sys.prefix))
FAST_DDS = {PREFIX / "lib" / name for name in ("librmw_fastrtps_cpp.so", "libfastrtps.so.2.14")}
OTHER = "rmw_fastrtps_cpp"
LINK_OPTIONS = ("-lrcutils", "-Wl,--allow-shlib-undefined", "-rdynamic")
LIBRARIES = {"rmw_program": ["-lrmw_fastrtps_cpp"], "rcl_node": ["-lrcl", "-lrmw_fastrtps_cpp"]}

# How Python programs start others; the command is in the arguments.
IMPORTS = "import asyncio, os, shlex, subprocess, sys\n"
COROUTINE = "asyncio.create_subprocess_exec(*sys.argv[1:])"
PARENTS = {
    "subprocess": "subprocess.run(sys.argv[1:], check=True)",
    "shell": "sys.exit(os.system(shlex.join(sys.argv[1:])))",
    "asyncio": f"async def go(): await (await {COROUTINE}).wait()\nasyncio.run(go())",
    "exec": "os.execv(sys.argv[1], sys.argv[1:])",
    "fork and exec": "os.fork() and os.wait() or os.execv(sys.argv[1], sys.argv[1:])",
    "grandchild": "subprocess.run(['sh', '-c', shlex.join(sys.argv[1:])], check=True)",
}
# What a Python program on rmw_manycore does so that its children load another middleware.
SELECTIONS = {
    "changed": f"os.environ['RMW_IMPLEMENTATION'] = {OTHER!r}",
    "removed": "del os.environ['RMW_IMPLEMENTATION']",
    "empty": "os.environ['RMW_IMPLEMENTATION'] = ''",
}
SHOW = """
import rclpy
from pathlib import Path
print(sys.argv[0])
print(rclpy.get_rmw_implementation_identifier())
print(Path('/proc/self/comm').read_text() + Path('/proc/self/maps').read_text())
"""
MULTIPROCESSING = """
import multiprocessing, sys
def show():
{show}
if __name__ == '__main__':
    child = multiprocessing.get_context('{method}').Process(target=show)
    child.start()
    child.join()
    sys.exit(child.exitcode)
"""


@dataclass(frozen=True)
class Shown:
    """The output of a program about itself."""

    arguments: list[str]
    identifier: str
    name: str
    libraries: set[Path]

    @property
    def is_manycore(self) -> bool:
        """Return whether it has this middleware alone, by name and files; anything else fails."""
        has_ours = PREFIX / "lib/librmw_manycore.so" in self.libraries
        assert has_ours != bool(FAST_DDS & self.libraries), self
        assert self.identifier == ("rmw_manycore" if has_ours else OTHER), self
        return has_ours


def shown(output: str) -> Shown:
    arguments, identifier, name, *maps = output.splitlines()
    libraries = {Path(line.split()[-1]) for line in maps if ".so" in line}
    return Shown(arguments.split(), identifier, name, libraries)


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the directory of C++ programs that are linked like the libraries of the wheels."""
    return made_once(tmp_path_factory, "programs", compile_programs)


def compile_programs(directory: Path) -> None:
    for name, libraries in LIBRARIES.items():
        compile_program(name, directory / name, *libraries)


def compile_program(name: str, output: Path, *libraries: str) -> None:
    headers = [f"-I{path}" for path in (PREFIX / "include").iterdir()]
    source = TESTS / "programs" / f"{name}.cpp"
    links = [f"-L{PREFIX}/lib", *libraries, *LINK_OPTIONS]
    subprocess.run(["c++", "-std=c++17", *headers, source, "-o", output, *links], check=True)


@pytest.fixture(params=LIBRARIES)
def program(request: pytest.FixtureRequest, programs: Path) -> list[str]:
    return [str(programs / request.param), "word", "two words"]


@pytest.fixture
def shell(platform: str) -> dict[str, str]:
    """Return the environment of a shell that sets nothing of ROS but RMW_IMPLEMENTATION."""
    variables = environment(platform)
    for name in (hook.LIBRARY_PATH, hook.WHEELS_BOOTSTRAPPED, hook.REPLACED):
        variables.pop(name, None)
    return variables


@pytest.fixture
def exported(shell: dict[str, str]) -> dict[str, str]:
    """Return the environment of a shell that has evaluated the output of `manycore env`."""
    script = ". /dev/stdin && exec env -0"
    lines = subprocess.check_output(manycore_command("env"), env=shell)
    output = subprocess.check_output(["sh", "-c", script], input=lines, env=shell).decode()
    return dict(entry.split("=", 1) for entry in output.split("\0") if entry)


def run(command: list[str], variables: Mapping[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, env=variables, capture_output=True, text=True, timeout=TIMEOUT_S)


def show(command: list[str], variables: Mapping[str, str]) -> Shown:
    done = run(command, variables)
    assert done.returncode == 0, done
    return shown(done.stdout)


def python(code: str, *arguments: str) -> list[str]:
    return [sys.executable, "-c", IMPORTS + code, *arguments]


@pytest.mark.parametrize("parent", PARENTS)
def test_a_program_in_cpp_has_the_middleware_of_its_parent(shell, program, parent) -> None:
    assert show(python(PARENTS[parent], *program), shell).is_manycore


@pytest.mark.parametrize("options", [[], ["-I"], ["-E"], ["-P"]], ids=str)
def test_options_of_python_do_not_matter(shell, program, options) -> None:
    interpreter, *words = python(PARENTS["subprocess"], *program)
    assert show([interpreter, *options, *words], shell).is_manycore
    assert show([interpreter, *options, "-c", f"import sys\n{SHOW}"], shell).is_manycore


@pytest.mark.parametrize("selection", SELECTIONS)
@pytest.mark.parametrize("parent", ["subprocess", "exec"])
def test_a_child_for_which_another_middleware_is_selected_has_that(
    shell, program, parent, selection
) -> None:
    code = f"{SELECTIONS[selection]}\n{PARENTS[parent]}"
    for child in (program, python(SHOW)):
        assert not show(python(code, *child), shell).is_manycore


def test_a_program_in_cpp_is_restarted_as_it_was_started(shell, programs) -> None:
    renamed = [str(programs / "rmw_program"), "a  b", "", "--ros-args"]
    code = f"{SELECTIONS['changed']}; os.execv(sys.argv[1], ['own name', *sys.argv[2:]])"
    done = show(python(code, *renamed), shell)
    assert not done.is_manycore
    assert done.arguments == ["own", "name", "a", "b", "--ros-args"]
    assert done.name == "rmw_program"


def test_what_a_shell_exports_is_for_children_of_python_too(exported, program) -> None:
    assert show(program, exported).is_manycore
    assert show(python(PARENTS["subprocess"], *program), exported).is_manycore


def test_a_program_in_cpp_needs_no_python_for_the_messages_of_rcl(exported, tmp_path) -> None:
    program = tmp_path / "program"
    compile_program("rcl_node", program, *LIBRARIES["rcl_node"], "-DONLY_FOR_MANYCORE")
    assert show([str(program)], exported).is_manycore
    done = run([str(program)], {**exported, "RMW_IMPLEMENTATION": OTHER})
    assert "undefined symbol: PyExc_RuntimeError" in done.stderr


@pytest.mark.parametrize("value", [OTHER, ""])
def test_what_a_shell_exports_is_for_rmw_manycore_only(exported, program, value) -> None:
    other = {**exported, "RMW_IMPLEMENTATION": value}
    for command in (program, python(SHOW), python(PARENTS["subprocess"], *program)):
        assert not show(command, other).is_manycore


@pytest.mark.parametrize("spelling", ["{}/", "{}/../standin", "{0}:{0}"])
def test_the_stand_ins_are_found_in_the_search_path_however_spelt(
    exported, program, spelling
) -> None:
    spelt = exported["LD_LIBRARY_PATH"].replace(str(STAND_INS), spelling.format(STAND_INS), 1)
    assert show(program, {**exported, "LD_LIBRARY_PATH": spelt}).is_manycore
    other = {**exported, "LD_LIBRARY_PATH": spelt, "RMW_IMPLEMENTATION": OTHER}
    assert not show(program, other).is_manycore


def test_a_program_that_cannot_be_restarted_without_them_is_refused(exported, program) -> None:
    """It fails with a message, and does not restart itself endlessly."""
    preloaded = {"LD_PRELOAD": str(STAND_INS / "librmw_fastrtps_cpp.so")}
    done = run(program, {**exported, **preloaded, "RMW_IMPLEMENTATION": OTHER})
    assert done.returncode == 102
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"rmw_manycore: RMW_IMPLEMENTATION is {OTHER}, ")


def test_a_running_program_is_refused_and_not_restarted(exported) -> None:
    code = "import ctypes; print('once', flush=True); ctypes.CDLL('librmw_fastrtps_cpp.so')"
    command = [sys.executable, "-S", "-c", code]
    done = run(command, {**exported, "RMW_IMPLEMENTATION": OTHER})
    assert (done.returncode, done.stdout) == (102, "once\n")
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"rmw_manycore: RMW_IMPLEMENTATION is {OTHER}, ")
    assert run(command, exported).returncode == 0


@pytest.mark.parametrize("method", ["spawn", "forkserver", "fork"])
def test_processes_of_multiprocessing(shell, tmp_path, method) -> None:
    body = "".join(f"    {line}\n" for line in SHOW.strip().splitlines())
    script = tmp_path / "parent.py"
    script.write_text(MULTIPROCESSING.format(show=body, method=method))
    assert show([sys.executable, str(script)], shell).is_manycore


def test_programs_without_ros_do_not_notice(shell) -> None:
    done = run(python(PARENTS["subprocess"], "/bin/sh", "-c", "ls -a /"), shell)
    assert (done.returncode, done.stderr) == (0, "")
    assert set(done.stdout.split("\n")) == {".", "..", "", *os.listdir("/")}


def test_a_child_with_an_environment_of_its_own_is_on_its_own(shell, programs) -> None:
    """A program started with LD_LIBRARY_PATH as its only variable."""
    libraries = os.pathsep.join(library_path(hook.plain_environment({}, sys.prefix)))
    variables = {"LD_LIBRARY_PATH": libraries}
    code = f"subprocess.run(sys.argv[1:], check=True, env={variables!r})"
    assert not show(python(code, str(programs / "rmw_program")), shell).is_manycore
