# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What Python launch files import of launch and launch_ros."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.launch_file import LaunchFile, read_launch_file

pytestmark = pytest.mark.unit

END = """
def generate_launch_description():
    from launch import LaunchDescription
    return LaunchDescription(actions())
"""


def read(directory: Path, text: str) -> LaunchFile:
    file = directory / "demo.launch.py"
    file.write_text(text + END)
    return read_launch_file(file)


@pytest.mark.parametrize(
    "imported",
    [
        "from launch.event_handlers.on_process_io import OnProcessIO",
        "from launch_ros.actions.set_ros_log_dir import SetROSLogDir",
        "from launch_ros.actions.ros_timer import ROSTimer",
        "from launch.conditions.if_condition import IfCondition",
        "from launch.actions.shutdown_action import Shutdown",
        "from launch.events.shutdown import Shutdown",
        "from launch_ros.parameters_type import ParameterFile",
        "import launch.utilities.type_utils",
        "from launch.utilities.type_utils import perform_typed_substitution",
    ],
)
def test_a_name_is_found_in_the_module_of_its_class(tmp_path: Path, imported: str) -> None:
    name = imported.rpartition(" ")[2]
    check = (
        f"def actions():\n    assert not repr({name}).startswith('launch'), {name}\n    return []"
    )
    assert read(tmp_path, f"{imported}\n{check}").nodes == ()


def test_the_same_class_is_found_everywhere(tmp_path: Path) -> None:
    lines = (
        "import launch",
        "from launch.actions import Shutdown, execute_process",
        "from launch.actions.shutdown_action import Shutdown as Same",
        "from launch.events.shutdown import Shutdown as Event",
        "def actions():",
        "    assert Same is Shutdown is launch.actions.Shutdown is not Event",
        "    return [execute_process.ExecuteProcess(cmd=['sh'])]",
    )
    (node,) = read(tmp_path, "\n".join(lines)).nodes
    assert node.command == ("sh",)


def test_annotations_may_have_any_name(tmp_path: Path) -> None:
    lines = (
        "from typing import List, Optional",
        "from launch_ros.parameters_type import SomeParameters",
        "from launch.frontend import Parser, parse_substitution",
        "def actions(some: Optional[SomeParameters] = None, more: List[Parser] = ()) -> Parser:",
        "    return [] if not isinstance(more, Parser) else more",
    )
    assert read(tmp_path, "\n".join(lines)).nodes == ()


@pytest.mark.parametrize(
    "use",
    [
        "get_node_name_count(None, 'n')",
        "get_node_name_count.some.part()",
        "[one for one in get_node_name_count]",
        "bool(get_node_name_count)",
        "setattr(get_node_name_count, 'level', 1)",
        "type('Mine', (), {}) if get_node_name_count else 0",
    ],
)
def test_the_use_of_an_unsupported_name_is_refused(tmp_path: Path, use: str) -> None:
    text = f"from launch_ros.utilities import get_node_name_count\ndef actions():\n    return {use}"
    expected = (
        r"demo.launch.py:3: expected a name of launch that is supported here, found 'launch_r"
    )
    with pytest.raises(MapfileError, match=expected):
        read(tmp_path, text)


def test_an_import_in_a_try_finds_out_what_is_supported(tmp_path: Path) -> None:
    lines = (
        "try:",
        "    from launch.actions import ExecuteProcess, DanceAction",
        "except ImportError:",
        "    DanceAction = None",
        "try:",
        "    import launch.dances",
        "except ImportError:",
        "    pass",
        "try:",
        "    from launch.actions.execute_process import ExecuteProcess",
        "except ImportError:",
        "    ExecuteProcess = None",
        "def actions():",
        "    assert DanceAction is None and ExecuteProcess is not None",
        "    return [ExecuteProcess(cmd=['sh'])]",
    )
    assert len(read(tmp_path, "\n".join(lines)).nodes) == 1
