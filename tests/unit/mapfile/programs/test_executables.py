# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Executables of packages, and the modules behind generated entry points."""

from __future__ import annotations

import site
import sys
import venv
from pathlib import Path

import pytest

from rmw_manycore_py import examples
from rmw_manycore_py.mapfile import check
from rmw_manycore_py.mapfile.programs.executables import (
    command_text,
    executables_of,
    find_executable,
)
from support.samples.entry_points import write_entry_point

pytestmark = pytest.mark.unit

EXAMPLES = {
    file.stem: file
    for file in Path(examples.__path__[0]).glob("*.py")
    if "def main(" in file.read_text()
}
BY_PIP = """\
#!/usr/bin/python3
import sys
from rmw_manycore_py.examples.talker import main as run
if __name__ == '__main__':
    sys.exit(run())
"""
BY_SETUPTOOLS = """\
#!/usr/bin/python3
# EASY-INSTALL-ENTRY-SCRIPT: 'rmw-manycore==0.1.0','console_scripts','manycore'
import sys
def importlib_load_entry_point(spec, group, name): ...
if __name__ == '__main__':
    sys.exit(load_entry_point('rmw-manycore==0.1.0', 'console_scripts', 'manycore')())
"""
BY_HAND = """\
#!/usr/bin/python3
from rmw_manycore_py.examples.talker import main
class Talker: ...
main()
"""


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Yield the directory of the executables of `demo`."""
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    directory = tmp_path / "lib/demo"
    directory.mkdir(parents=True)
    return directory


def source_of(script: Path, text: str) -> Path | None:
    script.write_text(text)
    script.chmod(0o755)
    program = find_executable("demo", script.name)
    assert program is not None
    assert program.argv == (str(script),)
    return program.source


def test_the_examples_are_executables() -> None:
    assert set(EXAMPLES) <= set(executables_of("rmw_manycore"))


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_source_of_an_example_is_its_module(name: str) -> None:
    program = find_executable("rmw_manycore", name)
    assert program is not None
    assert program.source == EXAMPLES[name]


def test_scripts_of_installers_show_the_module_they_start(installed: Path) -> None:
    assert source_of(installed / "talker", BY_PIP) == EXAMPLES["talker"]
    cli = source_of(installed / "tool", BY_SETUPTOOLS)
    assert cli is not None
    assert cli.name == "rmw_manycore_program.py"


def test_scripts_with_code_of_their_own_are_their_own_source(installed: Path) -> None:
    script = installed / "talker"
    assert source_of(script, BY_HAND) == script
    assert source_of(script, "#!/usr/bin/python3\nprint('unclear (\n") == script


def test_scripts_of_an_installed_ros_run_in_the_environment_that_extends_its_python(
    installed: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    python = Path(sys.executable).resolve()
    venv.create(tmp_path / "other", symlinks=True)
    for name, interpreter in {"system": python, "other": tmp_path / "other/bin/python"}.items():
        script = installed / name
        script.write_text(f"#!{interpreter}\n")
        script.chmod(0o755)

    def argv(name: str) -> tuple[str, ...]:
        program = find_executable("demo", name)
        assert program is not None
        return program.argv

    assert argv("system") == (str(installed / "system"),)
    # As in an environment that sees the packages of its base.
    monkeypatch.setattr(site, "PREFIXES", [sys.prefix, sys.base_prefix])
    assert argv("system") == (sys.executable, str(installed / "system"))
    assert argv("other") == (str(installed / "other"),)


def test_topics_of_a_package_executable_are_known(tmp_path: Path) -> None:
    mapfile = tmp_path / "mapfile.yaml"
    mapfile.write_text("nodes:\n  a: {cluster: 1, package: rmw_manycore, executable: talker}\n")
    (topic,) = check(mapfile).topics
    assert (topic.name, topic.type) == ("/chatter", "std_msgs/msg/String")


def test_a_console_script_is_started_by_the_file_that_pip_wrote() -> None:
    """Its name labels the process; that of `python -c` would be a line of code."""
    program = find_executable("rmw-manycore", "manycore")
    assert program is not None
    assert program.argv == (str(Path(sys.executable).with_name("manycore")),)


def test_an_entry_point_without_a_script_is_named_by_package_and_executable(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_entry_point(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    program = find_executable("my_robot", "detector")
    assert program is not None
    assert program.source == tmp_path / "my_robot.py"
    assert command_text(["taskset", "1", *program.argv, "x y"]) == (
        "taskset 1 my_robot detector 'x y'"
    )
    assert command_text(["python3", "-c", "print()"]) == "python3 -c 'print()'"
