# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages as text, with messages of the real packages."""

import array
import json
import random

import pytest
import yaml
from geometry_msgs.msg import PoseStamped
from rcl_interfaces.msg import Log
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Byte, Float64MultiArray, MultiArrayDimension, MultiArrayLayout, String
from test_msgs.msg import BoundedSequences

from rmw_manycore_py.cli.common.message_text import (
    ELLIPSIS,
    SHOWN_LENGTH,
    Shown,
    to_csv,
    to_plain,
    to_yaml,
)
from rmw_manycore_py.cli.common.printing import echo

pytestmark = pytest.mark.unit


def test_a_string_is_printed_as_ros2_prints_it() -> None:
    assert to_yaml(String(data="Hello World: 1")) == "data: 'Hello World: 1'\n"


CONTROLS = [chr(code) for code in (*range(1, 0x20), *range(0x7F, 0xA1))]
REORDERING = [chr(code) for code in (0x61C, *range(0x200B, 0x2010), *range(0x2028, 0x202F))]
OTHERS = [*"ab :#-'\"\\,{}[]&*!|>%@`?~0", "\u2066", "\u2069", "\ufeff", "é", "א", "م", "😀"]


def printed(text: str, capsys: pytest.CaptureFixture[str], **options: bool) -> str:
    """Return a message with this text as it is printed."""
    echo(to_yaml(String(data=text), Shown(), **options))
    return capsys.readouterr().out


@pytest.mark.parametrize("flow_style", [False, True])
def test_any_string_is_read_back_from_what_is_printed(flow_style, capsys) -> None:
    generator = random.Random(8)
    for _ in range(2000):
        parts = generator.choices([*CONTROLS, *REORDERING, *OTHERS], k=generator.randrange(9))
        text = "".join(parts)
        output = printed(text, capsys, flow_style=flow_style)
        assert yaml.safe_load(output) == {"data": text}, output
        assert not {*CONTROLS, "\u202e", "\u2066"} - {"\n", "\xa0"} & set(output)


def test_marks_of_arabic_and_hebrew_texts_are_printed_as_they_are(capsys) -> None:
    assert printed("abc\u200fdef\u200e\u061c", capsys) == "data: abc\u200fdef\u200e\u061c\n\n"


def test_nested_messages_keep_the_order_of_their_fields() -> None:
    text = to_yaml(PoseStamped())
    assert text.index("header:") < text.index("frame_id:") < text.index("orientation:")
    assert yaml.safe_load(text)["pose"]["orientation"]["w"] == 1.0


def test_long_arrays_and_strings_are_shortened() -> None:
    image = Image(data=array.array("B", range(200)), encoding="x" * 200)
    shown = yaml.safe_load(to_yaml(image))
    assert shown["data"] == [*range(SHOWN_LENGTH), ELLIPSIS]
    assert shown["encoding"] == "x" * SHOWN_LENGTH + ELLIPSIS


def test_json_has_everything() -> None:
    message = Float64MultiArray(data=[0.5] * 200)
    assert json.loads(json.dumps(to_plain(message)))["data"] == [0.5] * 200


def test_a_byte_is_a_number() -> None:
    assert to_plain(Byte(data=b"\x07")) == {"data": 7}


def test_a_shortened_string_at_the_end_keeps_its_dots() -> None:
    assert to_yaml(String(data="Hello World"), Shown(5)) == "data: Hello...\n"


def test_array_types_are_named_in_full() -> None:
    left_out = Shown(arrays=False)
    bounded = to_plain(BoundedSequences(), left_out)
    assert bounded["float64_values"] == "<sequence type: double[3], length: 0>"
    assert bounded["string_values"] == "<sequence type: string[3], length: 0>"
    dimensions = to_plain(MultiArrayLayout(), left_out)["dim"]
    assert dimensions == "<sequence type: std_msgs/msg/MultiArrayDimension, length: 0>"


def test_arrays_and_strings_may_be_left_out() -> None:
    info = CameraInfo(d=[1.0, 2.0], distortion_model="plumb_bob")
    plain = to_plain(info, Shown(arrays=False, strings=False))
    assert plain["d"] == "<sequence type: double, length: 2>"
    assert plain["k"] == "<array type: double[9]>"
    assert plain["distortion_model"] == "<string length: <9>>"


def test_csv_has_the_values_in_the_order_of_the_fields() -> None:
    pose = PoseStamped()
    pose.header.frame_id, pose.pose.position.y = "map", 2.5
    assert to_csv(pose) == "0,0,map,0.0,2.5,0.0,0.0,0.0,0.0,1.0"


def test_csv_has_a_line_for_a_message() -> None:
    log = Log(name="a\nb", msg="\x1b[31m\ttext", file="\\n", function="\u00e9")
    assert to_csv(log) == r"0,0,0,a\nb,\x1b[31m\ttext,\n,é,0"


def test_a_single_value_is_a_line() -> None:
    assert to_yaml(3) == "3\n"
    assert to_yaml("text") == "text\n"


def test_flow_style_is_for_arrays() -> None:
    """As with ros2: a line per field, each array in one line."""
    layout = MultiArrayLayout(dim=[MultiArrayDimension(label="x", size=2, stride=2)])
    text = to_yaml(Float64MultiArray(layout=layout, data=[1.0, 2.0]), flow_style=True)
    assert text.splitlines() == [
        "layout:",
        "  dim: [{label: x, size: 2, stride: 2}]",
        "  data_offset: 0",
        "data: [1.0, 2.0]",
    ]
