# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore component` with containers that are rclpy nodes: no wheel contains rclcpp's."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from support import IS_MANYCORE
from support.nodes.ros import announce, peer_node
from support.processes.commands import manycore_command, peer_command
from support.processes.program import Program

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

SPEAKER = ("demo", "demo::Speaker")


def container(name: str = "box") -> None:
    """Act as a container: loading creates a real node whose parameters show the request."""
    import rclpy
    from composition_interfaces.srv import ListNodes, LoadNode, UnloadNode
    from rclpy.node import Node
    from rclpy.parameter import Parameter

    nodes: dict[int, Node] = {}

    def load(request, response):
        if request.plugin_name != SPEAKER[1]:
            response.error_message = "no such plugin"
            return response
        overrides = [Parameter.from_parameter_msg(p) for p in request.parameters]
        rules = [word for rule in request.remap_rules for word in ("-r", rule)]
        node = Node(
            request.node_name or "speaker",
            namespace=request.node_namespace,
            parameter_overrides=overrides,
            automatically_declare_parameters_from_overrides=True,
            cli_args=["--ros-args", *rules] if rules else [],
            use_global_arguments=False,
        )
        announce(f"log level {request.log_level}, extra {len(request.extra_arguments)}")
        rclpy.get_global_executor().add_node(node)
        response.unique_id = len(nodes) + 1
        nodes[response.unique_id] = node
        response.success, response.full_node_name = True, node.get_fully_qualified_name()
        return response

    def unload(request, response):
        node = nodes.pop(request.unique_id, None)
        if node is None:
            response.error_message = "no node of that id"
            return response
        node.destroy_node()
        response.success = True
        return response

    def list_nodes(_request, response):
        response.unique_ids = list(nodes)
        response.full_node_names = [n.get_fully_qualified_name() for n in nodes.values()]
        return response

    with peer_node(name) as node:
        for kind, service, answer in (
            (LoadNode, "load_node", load),
            (UnloadNode, "unload_node", unload),
            (ListNodes, "list_nodes", list_nodes),
        ):
            node.create_service(kind, f"~/_container/{service}", answer)
        announce("ready")
        rclpy.spin(node)


LOAD = ("component", "load", "/box", *SPEAKER)
UNLOAD = ("component", "unload", "/box")


@pytest.fixture
def box(start) -> Program:
    box = start(peer_command(container))
    box.wait_for("ready")
    return box


def test_components_are_loaded_listed_and_unloaded(box, manycore) -> None:
    options = ("-n", "left", "--node-namespace", "/demo", "--log-level", "warn", "-e", "x:=1")
    loaded = manycore(*LOAD, *options, "-p", "gain:=2.5", "-p", "words:=hello")
    assert loaded == "Loaded component 1 into '/box' container node as '/demo/left'"
    box.wait_for("^log level 30, extra 1$")
    assert manycore("param", "get", "/demo/left", "gain") == "Double value is: 2.5"
    assert manycore(*LOAD, "-q", "-r", "__node:=renamed", "--log-level", "10") == "2  /renamed"
    assert manycore("component", "list").splitlines() == [
        "/box",
        "  1  /demo/left",
        "  2  /renamed",
    ]
    assert manycore("component", "list", "/box").splitlines() == ["1  /demo/left", "2  /renamed"]
    assert manycore("component", "list", "--containers-only") == "/box"
    listed = json.loads(manycore("component", "list", "--json"))
    assert listed == {"/box": [{"id": 1, "node": "/demo/left"}, {"id": 2, "node": "/renamed"}]}
    assert manycore(*UNLOAD, "1") == "Unloaded component 1 from '/box' container node"
    assert manycore(*UNLOAD, "2", "-q") == "2"
    assert manycore("node", "list") == "/box"


@pytest.mark.usefixtures("box")
def test_components_that_cannot_be_loaded_or_unloaded(manycore) -> None:
    gone = manycore(*UNLOAD, "7", status=1)
    assert "Failed to unload component 7 from '/box' container node\n    No node of that id" in gone
    refused = manycore("component", "load", "/box", "demo", "demo::Hearer", status=1)
    assert "Failed to load component: No such plugin" in refused
    assert "-p: expected name:=value, found 'gain'" in manycore(*LOAD, "-p", "gain", status=2)
    assert "--log-level" in manycore(*LOAD, "--log-level", "loud", status=2)
    unknown = manycore("component", "list", "/bx", status=1)
    assert unknown == "manycore: Unable to find container node '/bx'; did you mean '/box'?"


def installed(prefix: Path) -> str:
    """Install a package with components, and rclcpp's container in Python; return the prefix."""
    index = prefix / "share/ament_index/resource_index"
    for kind, package, text in (
        (
            "rclcpp_components",
            "demo",
            "demo::Speaker;lib/libdemo.so\ndemo::Hearer;lib/libdemo.so\n",
        ),
        ("packages", "demo", ""),
    ):
        (index / kind).mkdir(parents=True)
        (index / kind / package).write_text(text)
    program = prefix / "lib/rclcpp_components/component_container"
    program.parent.mkdir(parents=True)
    tests = Path(__file__).parents[1]
    program.write_text(
        f"#!{sys.executable}\nimport sys\nsys.path[:0] = [{str(tests)!r}, {str(tests)!r} + "
        "'/integration']\nimport rclpy\nargs = sys.argv\ninit = rclpy.init\n"
        "rclpy.init = lambda: init(args=args)\nfrom test_components import container\ncontainer()\n"
    )
    program.chmod(0o755)
    return str(prefix)


def test_registered_types(manycore, tmp_path) -> None:
    prefix = {"AMENT_PREFIX_PATH": installed(tmp_path / "prefix")}
    types = ("component", "types")
    assert manycore(*types, **prefix).splitlines()[:3] == [
        "demo",
        "  demo::Speaker",
        "  demo::Hearer",
    ]
    assert manycore(*types, "demo", **prefix).splitlines() == ["demo::Speaker", "demo::Hearer"]
    unknown = manycore(*types, "dmo", status=1, **prefix)
    assert "Unable to find package 'dmo'; did you mean 'demo'?" in unknown


def test_a_container_of_its_own(start, manycore, tmp_path) -> None:
    prefix = {"AMENT_PREFIX_PATH": installed(tmp_path / "prefix")}
    alone = ("component", "standalone", *SPEAKER, "-n", "left", "-c", "own_box")
    missing = manycore(*alone, status=1)
    assert "Package 'rclcpp_components' not found" in missing
    # Without the middleware in its environment it restarts itself, and starts one container.
    program = start(manycore_command(*alone), RMW_IMPLEMENTATION="", **prefix)
    program.wait_for("^log level 0, extra 0$")
    assert manycore("component", "list").splitlines() == ["/own_box", "  1  /left"]
    assert manycore("node", "list").splitlines() == ["/left", "/own_box"]
    program.wait_for("^Loaded component 1 into '/own_box' container node as '/left'$")
    assert program.stop() == 0, program
    refused = manycore(*alone[:2], "demo", "demo::Hearer", "-c", "own_box", status=1, **prefix)
    assert "Failed to load component: No such plugin" in refused
