# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Packages of definitions, builds of them, and nodes that use the types.

    python -m support.installs.building FUNCTION ARGUMENTS..

The nodes are separate programs: Python looks for built packages when it starts, before a fork
server could know where those of a test are.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from support.nodes.ros import announce, peer_node, spin, spin_until, type_of
from support.processes.commands import manycore_command

BUILD_TIMEOUT_S = 900  # also on a busy machine
THINGS = "things_msgs"
DEFINITIONS = {
    "things_msgs/msg/Thing.msg": (
        '# A thing.\nfloat64 x\ngeometry_msgs/Pose pose\nPart[] parts\nstring name "a thing"\n'
    ),
    "things_msgs/msg/Part.msg": "uint8 LARGEST=200\nint32 number\nint32[<=4] few\n",
    "things_msgs/msg/Mark.idl": (
        "module things_msgs { module msg {\n"
        "  struct Mark { sequence<double> at; wstring text; };\n"
        "}; };\n"
    ),
    "things_msgs/srv/Count.srv": "Thing thing\n---\nint32 parts\n",
    "things_msgs/action/Collect.action": "int32 number\n---\nPart[] parts\n---\nPart part\n",
}
TINY = {"tiny_msgs/msg/Tiny.msg": "int32 number\n"}


def write_definitions(directory: Path, definitions: dict[str, str]) -> Path:
    """Write definition files below a directory and return it."""
    for name, text in definitions.items():
        file = directory / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    return directory


def interface(
    *words: str | Path, env: dict[str, str], status: int = 0
) -> subprocess.CompletedProcess[str]:
    """Run a verb of `manycore interface` and return its output."""
    command = [str(word) for word in manycore_command("interface", *words)]
    done = subprocess.run(
        command, env=env, capture_output=True, text=True, timeout=BUILD_TIMEOUT_S, cwd="/"
    )
    assert done.returncode == status, f"{command}\n{done.stdout}\n{done.stderr}"
    return done


def node_command(function: str, *arguments: str) -> list[str]:
    """Return the command that runs a function of this file in a new interpreter."""
    return [sys.executable, "-m", __name__, function, *arguments]


def answer() -> None:
    """Print things; serve /count and the action /collect."""
    from rclpy.action import ActionServer

    with peer_node("answerer") as node:
        thing, count, collect = _types()
        part = type_of("things_msgs/msg/Part")

        def counted(request, response):
            response.parts = len(request.thing.parts)
            return response

        def collected(goal):
            parts = [part(number=n) for n in range(goal.request.number)]
            goal.publish_feedback(collect.Feedback(part=parts[-1]))
            goal.succeed()
            return collect.Result(parts=parts)

        node.create_subscription(thing, "/things", lambda m: announce(f"heard {_text(m)}"), 10)
        node.create_service(count, "/count", counted)
        ActionServer(node, collect, "/collect", collected)
        announce("answering")
        spin(node)


def ask() -> None:
    """Call /count and /collect, then publish a thing periodically."""
    from rclpy.action import ActionClient

    with peer_node("asker") as node:
        thing, count, collect = _types()
        client, action = (
            node.create_client(count, "/count"),
            ActionClient(node, collect, "/collect"),
        )
        spin_until(node, lambda: client.service_is_ready() and action.server_is_ready())
        answered = client.call_async(count.Request(thing=_thing()))
        spin_until(node, answered.done)
        announce(f"counted {answered.result().parts}")
        accepted = action.send_goal_async(collect.Goal(number=3))
        spin_until(node, accepted.done)
        result = accepted.result().get_result_async()
        spin_until(node, result.done)
        announce(f"collected {[part.number for part in result.result().result.parts]}")
        publisher = node.create_publisher(thing, "/things", 10)
        node.create_timer(0.05, lambda: publisher.publish(_thing()))
        spin(node)


def say() -> None:
    """Publish a thing periodically."""
    with peer_node("speaker") as node:
        publisher = node.create_publisher(_types()[0], "/things", 10)
        node.create_timer(0.05, lambda: publisher.publish(_thing()))
        announce("saying")
        spin(node)


def _types():
    return [type_of(f"things_msgs/{n}") for n in ("msg/Thing", "srv/Count", "action/Collect")]


def _thing():
    thing, part = type_of("things_msgs/msg/Thing")(x=2.5), type_of("things_msgs/msg/Part")
    thing.pose.position.y = 4.0
    thing.parts = [part(number=7, few=[1, 2]), part(number=part.LARGEST)]
    return thing


def _text(thing) -> str:
    parts = [(part.number, list(part.few)) for part in thing.parts]
    return f"{thing.name} {thing.x} {thing.pose.position.y} {parts}"


HEARD = r"heard a thing 2\.5 4\.0 \[\(7, \[1, 2\]\), \(200, \[\]\)\]"

if __name__ == "__main__":
    {"answer": answer, "ask": ask, "say": say}[sys.argv[1]](*sys.argv[2:])
