# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Installed mapfiles by name."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.mapfile.installed import description, find_mapfile, installed_mapfiles
from support import MAPFILES

pytestmark = pytest.mark.unit


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_every_mapfile_has_a_name() -> None:
    files = {file.name for pattern in ("*.yaml", "*.map") for file in MAPFILES.glob(pattern)}
    named = {file.name for file in installed_mapfiles().values()}
    assert files - named == {"services_parameters.params.yaml"}


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("talker_listener", "talker_listener.yaml"),
        ("talker_listener.yaml", "talker_listener.yaml"),
        ("three_nodes", "three_nodes.yaml"),
        ("three_nodes.yaml", "three_nodes.yaml"),
        ("three_nodes.map", "three_nodes.map"),
    ],
)
def test_a_name_is_found_with_and_without_its_suffix(name: str, file: str) -> None:
    found = find_mapfile(name)
    assert found is not None
    assert (found.name, found.is_absolute()) == (file, True)


@pytest.mark.parametrize("file", ["talker_listener", "talker_listener.yaml", "talker_listener.map"])
def test_a_file_of_the_working_directory_wins(here: Path, file: str) -> None:
    (here / file).touch()
    assert find_mapfile("talker_listener") == Path(file)


def test_a_directory_is_no_mapfile(here: Path) -> None:
    (here / "talker_listener").mkdir()
    found = find_mapfile("talker_listener")
    assert found is not None
    assert found.name == "talker_listener.yaml"


@pytest.mark.parametrize("name", ["no-such", "services_parameters.params", "mapfiles/action.yaml"])
def test_other_names_are_unknown(name: str) -> None:
    assert find_mapfile(name) is None


def test_a_mapfile_describes_itself() -> None:
    for name, mapfile in installed_mapfiles().items():
        text = description(mapfile)
        assert text, name
        assert "Copyright" not in text
