# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Built packages that Python finds, in real processes of a virtual environment for the test."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import rmw_manycore_distribution
import rmw_manycore_interfaces
from support.installs.python_prefix import Prefix

pytestmark = pytest.mark.unit

ORIGIN = "import foo_msgs; print(foo_msgs.ORIGIN)"
BUILT, INSTALLED = "ORIGIN = 'built'", "ORIGIN = 'installed'"


class Built:
    """A directory with a built package foo_msgs, which is not compiled."""

    def __init__(self, directory: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.directory = directory
        monkeypatch.setenv("MANYCORE_INTERFACES", str(directory))
        self.prefix = Path(rmw_manycore_interfaces.own_prefix())
        self.package = self.prefix / "python/foo_msgs"
        self.package.mkdir(parents=True)
        (self.package / "__init__.py").write_text(BUILT)

    def run(self, python: Prefix, code: str, **variables: str) -> str:
        settings = {"RMW_IMPLEMENTATION": "", "MANYCORE_INTERFACES": str(self.directory)}
        done = python.run("-c", code, directory=self.directory, **{**settings, **variables})
        assert done.returncode == 0, done.stderr
        return done.stdout.strip()


@pytest.fixture
def python(tmp_path: Path) -> Prefix:
    return Prefix(tmp_path / "venv")


@pytest.fixture
def built(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Built:
    return Built(tmp_path / "interfaces", monkeypatch)


def test_a_built_package_is_found(python: Prefix, built: Built) -> None:
    assert built.run(python, ORIGIN) == "built"


def test_a_package_that_is_installed_later_wins(python: Prefix, built: Built) -> None:
    installed = python.site_packages / "foo_msgs"
    installed.mkdir()
    (installed / "__init__.py").write_text(INSTALLED)
    assert built.run(python, ORIGIN) == "installed"


def test_a_package_that_another_start_up_hook_finds_wins(python: Prefix, built: Built) -> None:
    """Like those of editable installs, which may extend the path after ours."""
    elsewhere = built.directory / "elsewhere/foo_msgs"
    elsewhere.mkdir(parents=True)
    (elsewhere / "__init__.py").write_text(INSTALLED)
    (python.site_packages / "zzz.pth").write_text(f"{elsewhere.parent}\n")
    assert built.run(python, ORIGIN) == "installed"


def test_a_folder_of_definitions_hides_no_package(python: Prefix, built: Built) -> None:
    (built.directory / "foo_msgs/msg").mkdir(parents=True)  # working directory of the program
    assert built.run(python, ORIGIN) == "built"


def test_what_is_not_complete_is_not_found(python: Prefix, built: Built) -> None:
    (built.directory / "foo_msgs").mkdir()
    built.package.rename(built.prefix.parent / "building")
    code = "import foo_msgs; print(getattr(foo_msgs, 'ORIGIN', None))"
    assert built.run(python, code) == "None"


def test_other_programs_see_the_prefix_where_there_is_a_path(python: Prefix, built: Built) -> None:
    show = "import os; print(os.environ.get('AMENT_PREFIX_PATH'))"
    assert built.run(python, show) == "None"
    assert built.run(python, show, AMENT_PREFIX_PATH="/opt/ros") == f"/opt/ros:{built.prefix}"
    again = f"/opt/ros:{built.prefix}"
    assert built.run(python, show, AMENT_PREFIX_PATH=again) == again


def test_without_built_packages_nothing_changes(python: Prefix, tmp_path: Path) -> None:
    show = "import sys; print([f for f in sys.meta_path if 'manycore' in repr(f)])"
    found = python.run("-c", show, RMW_IMPLEMENTATION="", HOME=str(tmp_path))
    assert found.stdout.strip() == "[]"


@pytest.mark.parametrize(
    ("variables", "place"),
    [
        ({"HOME": "/home/me"}, "/home/me/.local/share/rmw_manycore/interfaces"),
        ({"XDG_DATA_HOME": "/data"}, "/data/rmw_manycore/interfaces"),
        ({"HOME": "/h", "XDG_DATA_HOME": "rel"}, "/h/.local/share/rmw_manycore/interfaces"),
        ({"MANYCORE_INTERFACES": "/my", "XDG_DATA_HOME": "/data"}, "/my"),
    ],
)
def test_where_packages_are_kept(
    variables: dict[str, str], place: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("HOME", "XDG_DATA_HOME", "MANYCORE_INTERFACES"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert rmw_manycore_interfaces.directory() == place
    assert rmw_manycore_interfaces.own_directory().startswith(
        f"{place}/{rmw_manycore_distribution.NAME}-cpython-"
    )


def describe(prefix: Path, type_name: str, hash_string: str) -> None:
    file = (prefix / "share" / type_name).with_suffix(".json")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps({"type_hashes": [{"hash_string": hash_string}]}))


def test_a_package_whose_parts_have_changed_is_refused(python: Prefix, built: Built) -> None:
    """Its native code would access memory with another layout."""
    check = "import rmw_manycore_interfaces as i; i.check('foo_msgs')"
    manifest = built.prefix / "share/foo_msgs/manifest.json"
    manifest.parent.mkdir(parents=True)
    manifest.write_text(
        json.dumps({"dependencies": {"bar_msgs/msg/Bar": "RIHS01_a"}, "source": "/src"})
    )
    describe(built.prefix, "bar_msgs/msg/Bar", "RIHS01_a")
    built.run(python, check)
    describe(python.path, "bar_msgs/msg/Bar", "RIHS01_b")  # installed, so it takes precedence
    refused = f"try: {check.split(';')[1].strip()}\nexcept ImportError as e: print(e)"
    text = built.run(python, f"import rmw_manycore_interfaces as i\n{refused}")
    assert "hash RIHS01_a, but found RIHS01_b: run `manycore interface build /src`" in text
