# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameter files through rcl's library: sections of a node, types, and lines of errors.

tests/rmw/test_parameter_files.py compares generated files with nodes.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.ros.parameter_files import applies, read_file, read_scalar, values_for

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(
    ("section", "node", "is_its_own"),
    [
        ("/**", "/probe", True),
        ("/**", "/ns/sub/probe", True),
        ("/*", "/probe", True),
        ("/*", "/ns/probe", False),
        ("/**/probe", "/probe", True),
        ("/**/probe", "/ns/sub/probe", True),
        ("/**/probe", "/ns/sub/other", False),
        ("/ns/**", "/ns/sub/probe", True),
        ("/ns/**", "/other/probe", False),
        ("/*/sub/*", "/ns/sub/probe", True),
        ("/*/probe", "/ns/sub/probe", False),
        ("/**/sub/**/probe", "/ns/sub/probe", True),
        ("probe", "/probe", True),
        ("probe", "/ns/probe", False),
        ("/ns/probe", "/ns/probe2", False),
        ("/**" * 60 + "/absent", "/a" * 60, False),  # without backtracking
    ],
)
def test_a_star_is_one_part_of_a_name(section: str, node: str, is_its_own: bool) -> None:
    assert applies(section, node) == is_its_own


def test_sections_and_keys_may_be_repeated(tmp_path: Path) -> None:
    file = tmp_path / "p.yaml"
    file.write_text(
        "/**: {ros__parameters: {x: 1, y: 1, y: 2}}\n"
        "/probe: {ros__parameters: {x: 5, exclude: []}}\n"
        "/**: {ros__parameters: {x: 3, z: 4}}\n"
    )
    assert values_for(read_file(file), "/probe") == {"x": 5, "y": 2, "z": 4}
    assert values_for(read_file(file), "/other") == {"x": 3, "y": 2, "z": 4}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        *(("-.5", -0.5), ("+.5", 0.5), ("1e3", 1000.0), ("0483", 483.0), ("0777", 0o777)),
        *(("0x1F", 31), ("1_000", "1_000"), ("1:30", "1:30"), ("y", True), ("Off", False)),
        *(("inf", float("inf")), ("-.INF", -float("inf")), ("2024-01-01", "2024-01-01")),
        *(("---", "---"), ("", ""), ("null", "null"), ("[x", "[x")),
    ],
)
def test_scalars_have_the_types_of_rcl(text: str, value: Any) -> None:
    assert (read_scalar(text), type(read_scalar(text))) == (value, type(value))


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("a:\n  ros__parameters:\n    x: 1\n    y: [1, 2.5]\n", ":4: .*Sequence should be of same"),
        ("a:\n  b: 3\n", ":2: .*Cannot have a value before ros__parameters"),
        (
            "a:\n  ros__parameters: {x: 1}\nb c:\n  ros__parameters: {x: 1}\n",
            ":4: .*node name",
        ),
        ("a:\n  ros__parameters:\n\tx: 1\n", ":3: .*found character '.t' that cannot start"),
        ("a:\n  ros__parameters: {x: &n 1, y: *n}\n", ":2: .*Will not support aliasing"),
        (
            "a: {ros__parameters: {x: '\xff'}}\n",
            ": expected a parameter file that rcl",
        ),
    ],
)
def test_what_rcl_refuses_is_an_error_with_its_line(tmp_path: Path, text: str, error: str) -> None:
    file = tmp_path / "p.yaml"
    file.write_bytes(text.encode("latin-1"))
    with pytest.raises(MapfileError, match=rf"p\.yaml{error}") as caught:
        read_file(file)
    assert str(caught.value).isprintable()


def test_a_file_that_is_gone_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(MapfileError, match="a readable parameter file, found No such file"):
        read_file(tmp_path / "absent.yaml")
