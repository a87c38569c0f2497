# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameters on the command line of a node, as rcl reads them there."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile import check
from rmw_manycore_py.mapfile.placing.parameter_values import Values
from rmw_manycore_py.mapfile.placing.parameters import read_all
from rmw_manycore_py.mapfile.placing.placement import PlacedNode
from rmw_manycore_py.ros.parameter_files import read_text, values_for

pytestmark = pytest.mark.unit

Check = Callable[..., PlacedNode]


@pytest.fixture
def placed(tmp_path: Path) -> Check:
    """Return the node of a mapfile, with what its launch file and parameter file say."""
    (tmp_path / "probe.py").write_text("")

    def check_node(node: str, launch: str = "", file: str = "") -> PlacedNode:
        (tmp_path / "demo.launch.py").write_text(
            "from launch import LaunchDescription\n"
            "from launch_ros.actions import ComposableNodeContainer, Node, SetParameter\n"
            "from launch_ros.descriptions import ComposableNode\n"
            "from launch_ros.parameter_descriptions import ParameterFile\n"
            "def node(parameters, **more):\n"
            "    return Node(executable='sh', parameters=parameters, **more)\n"
            f"FILE = '{tmp_path}/p.yaml'\n"
            f"def generate_launch_description():\n    return LaunchDescription([{launch}])\n"
        )
        (tmp_path / "p.yaml").write_text(file)
        text = "launch_path: demo.launch.py\n" * bool(launch) + f"nodes: {{{node}}}\n"
        (tmp_path / "map.yaml").write_text(text)
        return check(tmp_path / "map.yaml").nodes[0]

    return check_node


def effective(node: PlacedNode) -> dict[str, Any]:
    """Return what rcl makes of the sources of a node."""
    return values_for(read_all(node.parameter_sources), node.full_name)


OF_A_PATTERN = "/**/probe: {ros__parameters: {x: 2}}\n"


def test_a_file_of_a_launch_file_overrules_values_before_it(placed: Check) -> None:
    launch = "node([{'x': 1}, FILE], name='probe')"
    node = placed("probe: {cluster: 1}", launch, OF_A_PATTERN)
    assert (effective(node), node.parameters) == ({"x": 2}, {})


def test_values_of_a_launch_file_overrule_a_file_before_them(placed: Check) -> None:
    launch = "node([FILE, {'x': 1}], name='probe')"
    node = placed("probe: {cluster: 1}", launch, OF_A_PATTERN)
    assert (effective(node), node.parameters) == ({"x": 1}, {"x": 1})


def test_all_sections_of_a_file_with_substitutions_count(placed: Check) -> None:
    sections = ("/**", "/*", "/**/probe", "probe", "/**/**")
    file = "".join(
        f"'{section}': {{ros__parameters: {{p{number}: $(eval '1 + {number}')}}}}\n"
        for number, section in enumerate(sections)
    )
    launch = "node([ParameterFile(FILE, allow_substs=True)], name='probe')"
    node = placed("probe: {cluster: 1}", launch, file)
    assert effective(node) == {f"p{number}": number + 1 for number in range(5)}
    (generated,) = node.generated_files
    assert node.argv[-2:] == ["--params-file", "parameters/probe.1.yaml"]
    assert node.command(Path("/run/1"))[-1] == "/run/1/probe.1.yaml"
    assert len(read_text(generated.text, Path())) == 5


def test_values_of_a_node_in_a_namespace_are_for_it_alone(placed: Check) -> None:
    launch = "node([FILE, {'x': 3}], name='probe', namespace='ns')"
    file = "/**: {ros__parameters: {y: 1}}\n/ns/probe: {ros__parameters: {x: 2}}\n"
    node = placed("/ns/probe: {cluster: 1}", launch, file)
    assert effective(node) == {"x": 3, "y": 1}
    (generated,) = node.generated_files
    assert read_text(generated.text, Path()) == [("/ns/probe", {"x": 3})]


def test_parameters_set_for_all_nodes_rank_before_those_of_a_node(placed: Check) -> None:
    launch = "SetParameter('x', 1), node([{'x': 2}], name='probe', namespace='ns')"
    node = placed("/ns/probe: {cluster: 1}", launch)
    assert effective(node) == {"x": 2}
    assert node.argv[-4:-2] == ["-p", "x:=1"]


@pytest.mark.parametrize(
    ("sections", "by_option"),
    [
        (("/**: {ros__parameters: {x: 2}}", "/other: {ros__parameters: {x: 3}}"), True),
        (("/probe: {ros__parameters: {x: 2}}", "/**: {ros__parameters: {x: 3}}"), True),
        (("/**: {ros__parameters: {x: 2}}", "/probe: {ros__parameters: {x: 3}}"), False),
        (("/**: {ros__parameters: {x: true}}",), False),  # rcl would keep both types
    ],
)
def test_parameters_of_the_mapfile_win(
    placed: Check, sections: tuple[str, ...], by_option: bool
) -> None:
    values = "script: probe.py, param_file: p.yaml, parameters: {x: 1}"
    node = placed(f"probe: {{cluster: 1, {values}}}", file="\n".join(sections))
    assert effective(node)["x"] == 1
    assert effective(node)["x"] is not True
    assert (node.argv[-2:] == ["-p", "x:=1"]) == by_option
    assert len(node.generated_files) == (0 if by_option else 1)


def test_parameters_of_a_node_that_names_itself_are_for_any_name(placed: Check) -> None:
    file = "/**: {ros__parameters: {x: 1}}\n/own_name: {ros__parameters: {x: 2}}\n"
    launch = "node([FILE])"
    node = placed("sh: {cluster: 1, parameters: {x: 3}}", launch, file)
    assert values_for(read_all(node.parameter_sources), "/own_name") == {"x": 3}


def test_components_get_what_rcl_reads_for_them(placed: Check) -> None:
    file = "/**/lens: {ros__parameters: {x: -.5, y: $(eval '1 + 1'), none: []}}\n"
    lens = (
        "ComposableNode(package='p', plugin='p::Lens', name='lens', namespace='/left', "
        "parameters=[{'x': 1}, ParameterFile(FILE, allow_substs=True)])"
    )
    box = f"name='box', namespace='', executable='sh', composable_node_descriptions=[{lens}]"
    node = placed("box: {cluster: 1}", f"ComposableNodeContainer({box})", file)
    (component,) = node.rules.components
    assert component.parameters == {"x": -0.5, "y": 2}


def test_names_and_sizes_that_no_option_can_have_are_in_a_file(placed: Check) -> None:
    long = "x" * (1 << 17)  # more than Linux takes as one word
    launch = f"node([{{'odd name': 1, 'robot_description': '{long}'}}], name='probe')"
    node = placed("probe: {cluster: 1}", launch)
    assert effective(node) == {"odd name": 1, "robot_description": long}
    assert len(node.generated_files) == 1


def test_options_among_the_ros_arguments_of_a_launch_file_count(placed: Check) -> None:
    launch = "node([FILE], name='probe', ros_arguments=['-p', 'probe:x:=1', '--param', 'y:=-.5'])"
    node = placed("probe: {cluster: 1}", launch, OF_A_PATTERN)
    assert node.parameters == {"y": -0.5}


def test_parameters_of_the_mapfile_are_typed_by_rcl(placed: Check) -> None:
    numbers = "offset: -.5, zip: 0483, rate: 1e3, list: [1, .5], nested: {a: +.5}"
    values = f"{numbers}, flag: y, text: '1e3'"
    node = placed(f"probe: {{cluster: 1, script: probe.py, parameters: {{{values}}}}}")
    assert node.parameters == {
        "offset": -0.5,
        "zip": 483.0,
        "flag": True,
        "rate": 1000.0,
        "text": "1e3",
        "list": [1.0, 0.5],
        "nested.a": 0.5,
    }


def test_a_file_that_rcl_refuses_is_an_error_of_the_file(placed: Check) -> None:
    launch = "node([FILE], name='probe')"
    with pytest.raises(MapfileError, match=r"p\.yaml:2: expected a parameter file that rcl reads"):
        placed("probe: {cluster: 1}", launch, "/**:\n  ros__parameters: {x: [1, a]}\n")


@pytest.mark.parametrize("text", ["\x7f", "é\n", "\u2028", "\ufeff", "😀", " x ", "'", '"', "\\"])
def test_any_text_may_be_in_a_file(text: str) -> None:
    values = Values("/probe", {text: text}, by_option=False)
    assert read_text(values.text, Path()) == [("/probe", {text: text})]
