# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Definitions: the types they refer to, and the line of an error."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.errors import DefinitionError
from rmw_manycore_py.interfaces.definition import Definition, read_definition

pytestmark = pytest.mark.unit

IDL = """\
module my_msgs {
  module msg {
    struct Thing {
      geometry_msgs::msg::Pose pose;
      sequence<my_msgs::msg::Part> parts;
      long number;
    };
  };
};
"""
ENUM = """\
module my_msgs { module msg {
  enum Color { RED, GREEN };
  struct Thing {
    long a;
    Color b;
  };
}; };
"""


def read(directory: Path, name: str, text: str | bytes) -> Definition:
    file = directory / "my_msgs" / name
    file.parent.mkdir(parents=True)
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_definition(file, "my_msgs")


@pytest.mark.parametrize(
    ("name", "text", "line", "expected"),
    [
        ("msg/A.msg", "int32 a\n\nint32 b c d]\n", 3, "int32 b c d]"),
        ("msg/A.msg", "int32 a\nint32\n", 2, "a field or a constant, found 'int32'"),
        ("msg/A.msg", "# x\nint32 a\nfloat64 a\n", 3, "float64 a"),
        ("msg/A.msg", "uint8 B=256\n", 1, "uint8 B=256"),
        ("msg/A.msg", "string<=4 s 'too long'\n", 1, "too long"),
        ("msg/A.msg", "int32 a\nint32 Big\n", 2, "int32 Big"),
        ("msg/A.msg", "int32 a\nstring from\n", 2, "no keyword of Python, C or C++"),
        ("msg/A.msg", "int32 double\n", 1, "no keyword of Python, C or C++"),
        ("msg/A.msg", "time stamp\n", 1, "expected builtin_interfaces/Time, found time"),
        ("msg/A.msg", b"# \xff\n", 0, "a text file in UTF-8"),
        ("msg/lower.msg", "int32 a\n", 0, "a name such as PoseStamped"),
        ("msg/A.srv", "---\n", 0, "a .msg or .idl file in a directory 'msg'"),
        ("srv/A.srv", "int32 a\n", 1, "2 parts"),
        ("srv/A.srv", "int32 a\n---\n---\nint32 b\n", 3, "2 parts"),
        ("srv/A.srv", "int32 a\n---\nint32\n", 3, "found 'int32'"),
        ("action/A.action", "int32 a\n---\nint32 b\n", 3, "3 parts"),
        ("action/A.action", "int32 a\n---\nint32 b\n---\nint32 c\nint32 =\n", 6, "int32 ="),
        ("msg/Thing.idl", IDL.replace("number;", "number"), 7, "expected IDL 4.2"),
        ("msg/Other.idl", IDL, 3, "expected my_msgs/msg/Other, and no other struct, found my_msgs"),
        ("msg/Thing.idl", IDL + "struct More { long a; };\n", 10, "found More, my_msgs/msg/Thing"),
        ("srv/Thing.idl", IDL, 3, "my_msgs/srv/Thing_Request and my_msgs/srv/Thing_Response"),
        ("msg/Thing.idl", ENUM, 5, "'Color b;': Unknown named type: Color"),
        ("msg/Thing.idl", IDL.replace("geometry_msgs::msg", "geometry_msgs"), 4, "::msg::Pose"),
        ("msg/Thing.idl", IDL.replace("number", "number[2][2]"), 6, "multidimensional array"),
        ("msg/Thing.idl", IDL.replace("long number", "string<0> number"), 6, "'string<0> number;'"),
        ("msg/Thing.idl", IDL.replace("number", "default"), 6, "no keyword of Python, C or C++"),
        ("msg/Thing.idl", IDL.replace("number", "parts"), 6, "a name for each member"),
        ("msg/Thing.idl", IDL[:-10], 7, "found Unexpected end-of-input."),
        ("msg/A.msg", "int32 a\n\n# below C:\\new\nint32 b\n", 3, "an IDL string can have"),
        ("msg/A.msg", 'int32 a\nstring B="\\u12"\n', 2, "an IDL string can have"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(
    tmp_path: Path, name: str, text: str | bytes, line: int, expected: str
) -> None:
    with pytest.raises(DefinitionError) as caught:
        read(tmp_path, name, text)
    (problem,) = caught.value.problems
    assert problem.file == tmp_path / "my_msgs" / name
    assert problem.line == line
    assert expected in str(problem)


def test_references_have_the_line_of_the_first_field(tmp_path: Path) -> None:
    text = "# Pose pose\nint32 n\ngeometry_msgs/Pose pose\nPart[] parts\nPart[2] more\n"
    definition = read(tmp_path, "msg/Thing.msg", text)
    assert definition.name == "my_msgs/msg/Thing"
    assert definition.references == {"geometry_msgs/msg/Pose": 3, "my_msgs/msg/Part": 4}


def test_idl_has_references_too(tmp_path: Path) -> None:
    definition = read(tmp_path, "msg/Thing.idl", IDL)
    assert definition.references == {"geometry_msgs/msg/Pose": 4, "my_msgs/msg/Part": 5}


def test_services_and_actions_refer_to_what_the_generators_add(tmp_path: Path) -> None:
    service = read(tmp_path / "s", "srv/Do.srv", "Part a\n---\nstd_msgs/Header b\n")
    assert service.references["my_msgs/msg/Part"] == 1
    assert service.references["std_msgs/msg/Header"] == 3
    assert service.references["service_msgs/msg/ServiceEventInfo"] == 0
    action = read(tmp_path / "a", "action/Go.action", "---\n---\nPart part\n")
    assert action.references["my_msgs/msg/Part"] == 3
    assert action.references["unique_identifier_msgs/msg/UUID"] == 0
