# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.programs.source import SourceNode, read_source

pytestmark = pytest.mark.unit


def scan_text(directory: Path, text: str) -> list[SourceNode]:
    file = directory / "node.py"
    file.write_text(text)
    return read_source(file).nodes


def test_a_class_shows_its_name_topics_and_types(tmp_path: Path) -> None:
    (node,) = scan_text(
        tmp_path,
        "import sensor_msgs.msg as sm\n"
        "import geometry_msgs.msg\n"
        "from rclpy.node import Node\n"
        "from std_msgs.msg import String as Text\n"
        "TOPIC = 'pose'\n"
        "class Relay(Node):\n"
        "    def __init__(self):\n"
        "        super().__init__('relay')\n"
        "        self.create_publisher(Text, 'out', 10)\n"
        "        self.create_publisher(sm.Image, topic='image', qos_profile=10)\n"
        "        self.create_subscription(geometry_msgs.msg.Pose, TOPIC, print, 10)\n",
    )
    assert node.name == "relay"
    assert node.publish == {"out": "std_msgs/msg/String", "image": "sensor_msgs/msg/Image"}
    assert node.subscribe == {"pose": "geometry_msgs/msg/Pose"}
    assert node.unclear == []


def test_nodes_made_by_functions_are_found(tmp_path: Path) -> None:
    first, second = scan_text(
        tmp_path,
        "import rclpy\n"
        "from std_msgs.msg import String\n"
        "def main():\n"
        "    node = rclpy.create_node('one')\n"
        "    node.create_publisher(String, 'a', 1)\n"
        "    other = rclpy.create_node('two')\n"
        "    other.create_subscription(String, 'a', print, 1)\n",
    )
    assert (first.name, first.publish) == ("one", {"a": "std_msgs/msg/String"})
    assert (second.name, second.subscribe) == ("two", {"a": "std_msgs/msg/String"})


def test_a_computed_topic_is_named_by_its_line(tmp_path: Path) -> None:
    (node,) = scan_text(
        tmp_path,
        "from rclpy.node import Node\n"
        "from std_msgs.msg import String\n"
        "class A(Node):\n"
        "    def __init__(self, name):\n"
        "        super().__init__(name)\n"
        "        self.create_publisher(String, f'{name}/out', 10)\n",
    )
    assert (node.name, node.publish, node.unclear) == (None, {}, [6])


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        ("Outputs(self, 'map')", True),
        ("supervise(self)", True),
        ("self._outputs = [Output(owner=self) for _ in range(2)]", True),
        ("tf2_ros.TransformBroadcaster(self)", True),
        ("tf2_ros.TransformListener(self._buffer, self)", False),
        ("ActionServer(self, Fibonacci, 'fibonacci', print)", False),
        ("executor.add_node(self)", False),
        ("super(A, self).__init__('a')", False),
        ("self.run()", False),
    ],
)
def test_code_that_gets_the_node_may_publish_with_it(
    tmp_path: Path, call: str, expected: bool
) -> None:
    (node,) = scan_text(
        tmp_path,
        "from rclpy.action import ActionServer\n"
        "from rclpy.node import Node\n"
        "import tf2_ros\n"
        "class A(Node):\n"
        "    def __init__(self, executor):\n"
        f"        {call}\n",
    )
    assert (node.is_shared, node.shows_publishers) == (expected, not expected)


@pytest.mark.parametrize(("call", "expected"), [("add(node)", True), ("rclpy.spin(node)", False)])
def test_a_function_may_share_its_node(tmp_path: Path, call: str, expected: bool) -> None:
    (node,) = scan_text(tmp_path, f"import rclpy\nnode = rclpy.create_node('one')\n{call}\n")
    assert node.is_shared is expected


def test_nothing_is_executed(tmp_path: Path) -> None:
    assert scan_text(tmp_path, "raise SystemExit('executed')\n") == []


def test_a_file_that_is_not_python_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MapfileError, match=r"node.py:1: expected valid Python"):
        scan_text(tmp_path, "class:\n")


@pytest.mark.parametrize(
    ("begin", "encoding"), [("", "utf-8-sig"), ("# coding: latin-1\n", "latin-1")]
)
def test_sources_in_other_encodings_are_read(tmp_path: Path, begin: str, encoding: str) -> None:
    path = tmp_path / "node.py"
    text = "import rclpy\n# Größe\nrclpy.create_node('größe_m')\n"
    path.write_bytes(f"{begin}{text}".encode(encoding))
    assert read_source(path).is_program


def test_publishers_of_lifecycle_nodes_are_found(tmp_path: Path) -> None:
    (node,) = scan_text(
        tmp_path,
        "from rclpy.lifecycle import LifecycleNode\n"
        "from std_msgs.msg import String\n"
        "class Detector(LifecycleNode):\n"
        "    def __init__(self):\n"
        "        super().__init__('detector')\n"
        "        self.create_lifecycle_publisher(String, 'boxes', 10)\n",
    )
    assert node.publish == {"boxes": "std_msgs/msg/String"}


@pytest.mark.parametrize(
    ("start", "expected"),
    [
        ("if __name__ == '__main__':\n    main()\n", True),
        ("main()\n", True),
        ("raise SystemExit(main())\n", True),
        ("try:\n    main()\nexcept KeyboardInterrupt:\n    pass\n", True),
        ("", False),
        ("if TYPE_CHECKING:\n    import rclpy\n", False),
        ("logger = logging.getLogger('x')\n", False),
    ],
)
def test_a_module_without_a_call_starts_nothing(tmp_path: Path, start: str, expected: bool) -> None:
    file = tmp_path / "node.py"
    file.write_text(f"'''Detects.'''\n\ndef main():\n    rclpy.spin(Detector())\n\n{start}")
    assert read_source(file).is_program is expected
