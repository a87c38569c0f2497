# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Import path of our own programs, in real Python processes started among hostile files."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from rmw_manycore_program import own_program
from support.installs.python_prefix import SHOW, Prefix

pytestmark = pytest.mark.unit

SHADOWED = ("random", "enum", "types", "re", "json", "shown", "rmw_manycore_py")
SHOW_IMPORTS = f"import random, enum, types, re\n{SHOW}"
PIP_SCRIPT = """import re
import sys
from rmw_manycore_program import manycore
if __name__ == '__main__':
    sys.argv[0] = re.sub(r'(-script|.exe)?$', '', sys.argv[0])
    sys.exit(manycore())
"""
CMAKE_SCRIPT = """import rmw_manycore_program
rmw_manycore_program.isolate_imports()
from shown import main
rmw_manycore_program.raise_on_interrupt()
main()
"""
CLI = """import rmw_manycore_program
import shown
def main():
    rmw_manycore_program.raise_on_interrupt()
    shown.main()
"""
# Interrupts the process once the start-up hooks have run, while it imports what it needs, or
# while it works; and prints a line if the process went on.
INTERRUPTED = "__import__('os').environ.get('INTERRUPTED')"
INTERRUPT = "__import__('os').kill(__import__('os').getpid(), __import__('signal').SIGINT)"
STAGES = ("start", "imports", "work")


@pytest.fixture(scope="module")
def prefix(tmp_path_factory: pytest.TempPathFactory) -> Prefix:
    """An installation with another package's start-up hook that imports something."""
    prefix = Prefix(tmp_path_factory.mktemp("prefix"))
    start, imports, work = (f"{INTERRUPTED} == '{stage}' and {INTERRUPT}" for stage in STAGES)
    hook = f"import pathlib, enum; {start}\n"
    (prefix.site_packages / "ros_wheels_bootstrapper.pth").write_text(hook)
    body = [work, *SHOW_IMPORTS.splitlines()]
    main = f"{imports}\ndef main():\n" + "".join(f"    {line}\n" for line in body)
    (prefix.site_packages / "shown.py").write_text(f"{main}if __name__ == '__main__': main()\n")
    cli = prefix.site_packages / "rmw_manycore_py" / "cli.py"
    cli.parent.mkdir()
    (cli.parent / "__init__.py").touch()
    cli.write_text(CLI)
    (prefix.path / "bin/manycore").write_text(PIP_SCRIPT)
    (prefix.path / "lib/rmw_manycore/talker").write_text(CMAKE_SCRIPT)
    return prefix


@pytest.fixture
def hostile(tmp_path: Path) -> Path:
    directory = tmp_path / "hostile"
    directory.mkdir()
    for name in SHADOWED:
        (directory / f"{name}.py").write_text(f"raise SystemError('{name} of {directory}')\n")
    return directory


@pytest.fixture(params=["module", "manycore", "executable"])
def own(request: pytest.FixtureRequest, prefix: Prefix) -> list[str | Path]:
    """The arguments that start one of our programs, without the interpreter."""
    commands: dict[str, list[str | Path]] = {
        "module": [prefix.site_packages / "rmw_manycore_program.py", "shown"],
        "manycore": [prefix.path / "bin/manycore"],
        "executable": [prefix.path / "lib/rmw_manycore/talker"],
    }
    return commands[request.param]


@pytest.mark.parametrize("rmw", ["rmw_manycore", "rmw_fastrtps_cpp"])
@pytest.mark.parametrize("entries", [None, "", ":", ":{more}", "{hostile}"])
def test_own_programs_import_what_is_installed(
    prefix: Prefix, hostile: Path, own: list, tmp_path: Path, entries: str | None, rmw: str
) -> None:
    variables = {"RMW_IMPLEMENTATION": rmw}
    if entries is not None:
        variables["PYTHONPATH"] = entries.format(more=tmp_path / "more", hostile=hostile)
    shown = prefix.show(*own, "a b", directory=hostile, **variables)
    assert shown["argv"][1:] == ["a b"]
    named = [entry for entry in variables.get("PYTHONPATH", "").split(":") if entry]
    rest = shown["path"][: len(shown["path"]) - len(named)]
    assert shown["path"] == [*rest, *named]
    assert not {"", str(hostile)} & set(rest)


def test_options_of_python_survive(prefix: Prefix, hostile: Path, own: list) -> None:
    shown = prefix.show("-X", "utf8", "-u", *own, directory=hostile, PYTHONPATH=":")
    assert shown["flags"] == 1
    assert shown["orig_argv"] == ["-X", "utf8", "-u", *map(str, own)]
    assert not {"", str(hostile)} & set(shown["path"])


def test_files_beside_the_script_are_not_imported(prefix: Prefix, own: list) -> None:
    beside = prefix.path / "bin/random.py", prefix.path / "lib/rmw_manycore/random.py"
    for file in beside:
        file.write_text("raise SystemError('random of bin')\n")
    shown = prefix.show(*own)
    for file in beside:
        file.unlink()
    assert not {str(file.parent) for file in beside} & set(shown["path"])


def test_an_installation_that_is_named_in_the_path_stays(prefix: Prefix, own: list) -> None:
    variables = {"PYTHONPATH": f":{prefix.site_packages}"}
    shown = prefix.show(*own, directory=prefix.site_packages, **variables)
    assert str(prefix.site_packages) in shown["path"]


@pytest.mark.parametrize("rmw", ["rmw_manycore", "rmw_fastrtps_cpp"])
def test_an_interruption_while_python_loads_ends_them_quietly(
    prefix: Prefix, own: list, rmw: str
) -> None:
    done = prefix.run(*own, INTERRUPTED="start", RMW_IMPLEMENTATION=rmw)
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGINT, "", "")


@pytest.mark.parametrize("own", ["manycore", "executable"], indirect=True)
def test_an_interruption_of_their_imports_ends_them_quietly(prefix: Prefix, own: list) -> None:
    done = prefix.run(*own, INTERRUPTED="imports")
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGINT, "", "")


def test_an_interruption_of_their_work_is_theirs(prefix: Prefix, own: list) -> None:
    done = prefix.run(*own, INTERRUPTED="work")
    assert "KeyboardInterrupt" in done.stderr


def test_other_programs_are_interrupted_by_the_rules_of_python(
    prefix: Prefix, tmp_path: Path
) -> None:
    script = tmp_path / "manycore"
    script.write_text(f"import shown\n{INTERRUPT}\n")
    for stage in ("start", "imports", "own line"):
        assert "KeyboardInterrupt" in prefix.run(script, INTERRUPTED=stage).stderr


@pytest.mark.parametrize("own", ["module", "executable"], indirect=True)
def test_it_works_where_no_start_up_hook_is_read(prefix: Prefix, hostile: Path, own: list) -> None:
    """As in an ordinary ROS 2, with rmw_manycore itself on PYTHONPATH."""
    variables = {"PYTHONPATH": f":{prefix.site_packages}"}
    shown = prefix.show("-S", *own, directory=hostile, **variables)
    assert shown["path"][-1] == str(prefix.site_packages)
    assert not {"", str(hostile)} & set(shown["path"])


def test_other_programs_keep_the_rules_of_python(prefix: Prefix, tmp_path: Path) -> None:
    script = tmp_path / "manycore"
    script.write_text(SHOW)
    shown = prefix.show(script, PYTHONPATH="/named")
    assert shown["path"][:2] == [str(tmp_path), "/named"]
    assert prefix.show("-c", SHOW, PYTHONPATH="/named")["path"][:2] == ["", "/named"]


def test_a_module_of_ours_is_named_in_the_command_line() -> None:
    python, program, *words = own_program("rmw_manycore_bridge", "inward")
    assert Path(program).is_file()
    assert words == ["rmw_manycore_bridge", "inward"]
    assert Path(python).is_file()
