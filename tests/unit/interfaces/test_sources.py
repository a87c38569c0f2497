# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Packages of definitions: which directories are some, and which are ambiguous."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.errors import DefinitionError, ManycoreError
from rmw_manycore_py.interfaces.sources import find_sources

pytestmark = pytest.mark.unit


def write(directory: Path, **files: str) -> Path:
    """Write files named like msg__Thing__msg for msg/Thing.msg."""
    for name, text in files.items():
        kind, stem, suffix = name.split("__")
        file = directory / kind / f"{stem}.{suffix}"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    return directory


def test_folders_and_packages_are_found_in_a_workspace(tmp_path: Path) -> None:
    write(tmp_path / "src/bare_msgs", msg__A__msg="int32 a\n")
    packaged = write(tmp_path / "src/some/folder", srv__B__srv="---\n")
    (packaged / "package.xml").write_text("<package><name>named_msgs</name></package>")
    ignored = write(tmp_path / "src/ignored_msgs", msg__A__msg="int32 a\n")
    (ignored / "COLCON_IGNORE").touch()
    found = find_sources([tmp_path])
    assert {name: list(s.definitions) for name, s in found.items()} == {
        "bare_msgs": ["bare_msgs/msg/A"],
        "named_msgs": ["named_msgs/srv/B"],
    }
    assert list(find_sources([tmp_path / "src/bare_msgs"])) == ["bare_msgs"]


def test_an_idl_file_made_of_a_definition_is_no_second_one(tmp_path: Path) -> None:
    made = "// generated from rosidl_adapter/resource/msg.idl.em\n"
    directory = write(tmp_path / "a_msgs", msg__A__msg="int32 a\n", msg__A__idl=made)
    (definition,) = find_sources([directory])["a_msgs"].definitions.values()
    assert definition.file == directory / "msg/A.msg"


def test_all_problems_are_reported_at_once(tmp_path: Path) -> None:
    write(tmp_path / "a_msgs", msg__A__msg="int32\n", msg__B__msg="int32 b\nfloat\n")
    write(tmp_path / "b_msgs", msg__C__msg="?\n")
    with pytest.raises(DefinitionError) as caught:
        find_sources([tmp_path])
    places = [(problem.file.name, problem.line) for problem in caught.value.problems]
    assert places == [("A.msg", 1), ("B.msg", 2), ("C.msg", 1)]


def test_names_that_collide_are_refused(tmp_path: Path) -> None:
    idl = "module a_msgs { module msg { struct A { long a; }; }; };"
    write(tmp_path / "x/a_msgs", msg__A__msg="int32 a\n", msg__A__idl=idl)
    with pytest.raises(DefinitionError, match="one definition of each type"):
        find_sources([tmp_path / "x"])
    write(tmp_path / "y/a_msgs", msg__PoseXY__msg="int32 a\n", msg__PoseXy__msg="int32 a\n")
    with pytest.raises(DefinitionError, match=r"generated files, pose_xy\.h, are not those of"):
        find_sources([tmp_path / "y"])


def test_two_packages_of_one_name_must_be_the_same(tmp_path: Path) -> None:
    write(tmp_path / "x/a_msgs", msg__A__msg="int32 a\n")
    write(tmp_path / "y/a_msgs", msg__A__msg="int32 a\n")
    assert find_sources([tmp_path])["a_msgs"].directory == tmp_path / "x/a_msgs"
    write(tmp_path / "y/a_msgs", msg__A__msg="int32 b\n")
    with pytest.raises(DefinitionError, match=r"expected one package 'a_msgs', found .*x/a_msgs"):
        find_sources([tmp_path])


@pytest.mark.parametrize(
    ("xml", "line", "expected"),
    [
        ("<package>\n<name>a</package>", 2, "expected XML"),
        ("<package><name>Bad-Name</name></package>", 0, "found 'Bad-Name'"),
        ("<package/>", 0, "found ''"),
        ('<?xml version="1.0" encoding="x"?><package/>', 1, "XML, found unknown encoding: x"),
        ('<?xml version="1.0" encoding="utf-7"?><package/>', 1, "multi-byte encodings"),
    ],
)
def test_a_package_without_a_good_name_is_refused(
    tmp_path: Path, xml: str, line: int, expected: str
) -> None:
    directory = write(tmp_path / "a_msgs", msg__A__msg="int32 a\n")
    (directory / "package.xml").write_text(xml)
    with pytest.raises(DefinitionError, match=expected) as caught:
        find_sources([tmp_path])
    assert caught.value.problems[0].line == line


def test_a_path_without_definitions_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(ManycoreError, match="found no definitions"):
        find_sources([tmp_path])
    with pytest.raises(ManycoreError, match="found no such directory"):
        find_sources([tmp_path / "none"])
