# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Completions that real shells offer, on a running platform."""

from __future__ import annotations

import subprocess
from collections.abc import Iterable
from pathlib import Path

import pytest

from support import IS_MANYCORE
from support.nodes.ros import announce, peer_node
from support.processes.commands import manycore_command, peer_command
from support.processes.platforms import environment

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

# For each line: call the completion function that the shell calls for Tab, and print its
# suggestions and a line END.
BASH = """
eval "$(manycore completion bash)"
compopt() { echo "compopt $*"; }
function=$(complete -p manycore | sed 's/.* -F \\([^ ]*\\) .*/\\1/')
for line in "$@"; do
    COMPREPLY=() COMP_WORDS=($line); [[ $line == *" " ]] && COMP_WORDS+=("")
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    $function manycore "${COMP_WORDS[COMP_CWORD]}"
    printf '%s\\n' "${COMPREPLY[@]}" END
done
"""
# zsh completes only inside its line editor, so stand-ins replace the functions that show results.
ZSH = """
compdef() { :; }
compadd() { while [[ $1 == -* ]]; do [[ $1 == -V ]] && shift; shift; done; print -l ${(P)1}; }
eval "$(manycore completion zsh)"
for line in "$@"; do
    words=(${(z)line}); CURRENT=$#words
    _manycore_completion
    print END
done
"""
FISH = """
manycore completion fish | source
for line in $argv
    complete --do-complete "$line" | string replace --regex '\\t.*' ''
    echo END
end
"""


def talking() -> None:
    import rclpy
    from std_msgs.msg import String
    from std_srvs.srv import SetBool

    with peer_node("talker") as node:
        node.create_publisher(String, "chatter", 1)
        node.create_publisher(String, "_hidden", 1)
        node.create_service(SetBool, "switch", lambda _request, response: response)
        announce("ready")
        rclpy.spin(node)


@pytest.fixture
def complete(start, platform):
    """Return a function that completes a line in a shell while the talker runs."""
    start(peer_command(talking)).wait_for("ready")
    program = Path(manycore_command()[0])

    def offered(command: list[str], directory: Path, lines: Iterable[str]) -> list[list[str]]:
        variables = environment(platform)
        path = f"{program.parent}:{variables['PATH']}"
        done = subprocess.run(
            [*command, *lines],
            env={**variables, "PATH": path, "HOME": str(directory)},
            cwd=directory,
            text=True,
            capture_output=True,
            check=True,
        )
        assert done.stderr == ""
        return [part.split() for part in done.stdout.split("END\n")[:-1]]

    return offered


def test_bash_completes(complete, tmp_path) -> None:
    (tmp_path / "my_map.yaml").touch()
    expected = {
        "manycore top": ["top", "topic"],
        "manycore node ": ["list", "info"],
        "manycore topic echo --qos-d": ["--qos-durability", "--qos-depth"],
        "manycore topic echo --qos-profile sen": ["sensor_data"],
        "manycore topic echo /": ["/chatter", "/parameter_events", "/rosout"],
        "manycore topic pub /chatter ": ["std_msgs/msg/String"],
        "manycore node info ": ["/talker"],
        "manycore service call /sw": ["/switch"],
        "manycore run talker_l": ["talker_listener"],
        "manycore run my": ["my_map.yaml"],
        "manycore run ./my": ["compopt", "-o", "default"],
        "manycore interface show std_srvs/srv/Set": ["std_srvs/srv/SetBool"],
        "manycore topic echo --platform no-such /ch": [],
    }
    found = complete(["bash", "--norc", "-c", BASH, "bash"], tmp_path, expected)
    assert dict(zip(expected, found, strict=True)) == expected


def test_nodes_of_a_run_are_offered(complete, start, tmp_path) -> None:
    mapfile = tmp_path / "sleepers.yaml"
    nodes = "".join(
        f"  {name}: {{command: sleep 1000, ros_arguments: false, cluster: 1, core: {core}}}\n"
        for core, name in enumerate(("left", "right"), start=1)
    )
    mapfile.write_text(f"nodes:\n{nodes}")
    run = start(manycore_command("run", str(mapfile), "--join"), HOME=str(tmp_path))
    run.wait_for("right started")
    verbs = ("restart", "stop", "logs", "attach")
    lines = [f"manycore {verb} {typed}" for verb in verbs for typed in ("", "le")]
    found = complete(["bash", "--norc", "-c", BASH, "bash"], tmp_path, lines)
    assert found == [["left", "right"], ["left"]] * len(verbs)


@pytest.mark.needs("zsh", "fish")
@pytest.mark.parametrize(
    ("shell", "options"), [("zsh", ["-f", "-c", ZSH, "zsh"]), ("fish", ["--no-config", "-c", FISH])]
)
def test_other_shells_complete(complete, tmp_path, shell: str, options: list[str]) -> None:
    expected = {
        "manycore top": ["top", "topic"],
        "manycore topic echo /ch": ["/chatter"],
        "manycore run talker_l": ["talker_listener"],
    }
    found = complete([shell, *options], tmp_path, expected)
    assert dict(zip(expected, found, strict=True)) == expected


def test_how_to_switch_it_on_is_printed(start) -> None:
    for shell, line in (
        ("/bin/bash", 'eval "$(manycore completion bash)"'),
        ("/usr/bin/fish", "manycore completion fish | source"),
    ):
        printed = start(manycore_command("completion"), SHELL=shell)
        assert printed.wait() == 0
        assert printed.lines[1].strip() == line
        assert len(printed.lines) == 3
