# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The selection and order of what is built; missing and circular references."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.errors import DefinitionError, ManycoreError
from rmw_manycore_py.interfaces.selection import Part, select
from rmw_manycore_py.interfaces.sources import find_sources

pytestmark = pytest.mark.unit


@pytest.fixture(autouse=True)
def nothing_built(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MANYCORE_INTERFACES", str(tmp_path / "built"))


def selected(directory: Path, files: dict[str, str], *only: str) -> list[Part]:
    for name, text in files.items():
        file = directory / "src" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    return select(find_sources([directory / "src"]), only)


def problems(directory: Path, files: dict[str, str], *only: str) -> list[str]:
    with pytest.raises(DefinitionError) as caught:
        selected(directory, files, *only)
    return [str(problem).removeprefix(f"{directory}/src/") for problem in caught.value.problems]


CHAIN = {
    "a_msgs/msg/Top.msg": "b_msgs/Middle middle\n",
    "a_msgs/srv/Call.srv": "---\n",
    "b_msgs/msg/Middle.msg": "c_msgs/Low low\ngeometry_msgs/Pose pose\n",
    "b_msgs/action/Go.action": "---\n---\n",
    "c_msgs/msg/Low.msg": "int32 a\n",
    "c_msgs/msg/Other.msg": "int32 a\n",
}


def test_packages_come_after_those_they_need(tmp_path: Path) -> None:
    parts = selected(tmp_path, CHAIN)
    assert [part.package for part in parts] == ["c_msgs", "b_msgs", "a_msgs"]
    assert all(part.is_whole for part in parts)
    assert parts[1].needed >= {"c_msgs", "geometry_msgs"}


def test_only_takes_a_type_and_all_that_is_in_it(tmp_path: Path) -> None:
    parts = selected(tmp_path, CHAIN, "b_msgs/msg/Middle")
    assert {part.package: [d.name for d in part.definitions] for part in parts} == {
        "b_msgs": ["b_msgs/msg/Middle"],
        "c_msgs": ["c_msgs/msg/Low"],
    }
    middle = parts[1]
    assert (middle.available, middle.is_whole) == (2, False)
    assert middle.share_of_code == 1 / 11  # an action consists of ten structures


def test_only_of_an_unknown_type_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(ManycoreError, match="--only a_msgs/msg/Tip: expected a type of"):
        selected(tmp_path, CHAIN, "a_msgs/msg/Tip")


def test_references_that_lead_nowhere_are_named_with_their_lines(tmp_path: Path) -> None:
    files = {
        "a_msgs/msg/A.msg": "int32 n\nno_msgs/B b\ngeometry_msgs/Posse c\nHere here\n",
    }
    assert problems(tmp_path, files) == [
        "a_msgs/msg/A.msg:2: expected no_msgs/msg/B in the paths, built before or installed, "
        "found no package 'no_msgs'",
        "a_msgs/msg/A.msg:3: expected geometry_msgs/msg/Posse in the paths, built before or "
        "installed, found a package 'geometry_msgs' without it",
        "a_msgs/msg/A.msg:4: expected a_msgs/msg/Here in the paths, built before or installed, "
        "found a package 'a_msgs' without it",
    ]


def test_what_is_left_out_may_be_wrong(tmp_path: Path) -> None:
    files = {"a_msgs/msg/A.msg": "no_msgs/B b\n", "a_msgs/msg/C.msg": "int32 c\n"}
    (part,) = selected(tmp_path, files, "a_msgs/msg/C")
    assert [definition.name for definition in part.definitions] == ["a_msgs/msg/C"]


def test_cycles_of_types_are_named_with_their_lines(tmp_path: Path) -> None:
    files = {"a_msgs/msg/A.msg": "int32 n\nB b\n", "a_msgs/msg/B.msg": "A[] a\n"}
    found = problems(tmp_path, files)
    assert [text.split(" expected")[0] for text in found] == [
        "a_msgs/msg/A.msg:2: a_msgs/msg/B:",
        "a_msgs/msg/B.msg:1: a_msgs/msg/A:",
    ]
    assert "a_msgs/msg/A -> a_msgs/msg/B" in found[0] + found[1]
    itself = {"a_msgs/msg/A.msg": "A a\n", "a_msgs/msg/B.msg": "int32 a\n"}
    assert problems(tmp_path, itself)[0].startswith("a_msgs/msg/A.msg:1: a_msgs/msg/A:")


def test_cycles_of_packages_are_errors_without_one_of_types(tmp_path: Path) -> None:
    files = {
        "a_msgs/msg/A.msg": "int32 n\n",
        "a_msgs/msg/B.msg": "b_msgs/D d\n",
        "b_msgs/msg/C.msg": "a_msgs/A a\n",
        "b_msgs/msg/D.msg": "int32 n\n",
    }
    found = problems(tmp_path, files)
    assert [text.split(" expected")[0] for text in found] == [
        "a_msgs/msg/B.msg:1: b_msgs:",
        "b_msgs/msg/C.msg:1: a_msgs:",
    ]
    assert len(selected(tmp_path, files, "a_msgs/msg/B")) == 2


def test_an_installed_package_is_what_others_are_built_with(tmp_path: Path) -> None:
    files = {
        "std_msgs/msg/Header.msg": "int32 other\n",
        "std_msgs/msg/Extra.msg": "int32 n\n",
        "a_msgs/msg/A.msg": "std_msgs/Header header\nstd_msgs/Extra extra\n",
    }
    (found,) = problems(tmp_path, files)
    assert found.startswith("a_msgs/msg/A.msg:2: expected std_msgs/msg/Extra")
    assert "a package 'std_msgs' without it" in found


def test_a_package_named_like_a_python_module_is_refused(tmp_path: Path) -> None:
    (found,) = problems(tmp_path, {"yaml/msg/A.msg": "int32 a\n"})
    assert "expected a name that no Python module has, found 'yaml'" in found
